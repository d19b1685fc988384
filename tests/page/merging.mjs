// States with decisions, drawn by chance, are merged into cubes, which say the same of the same states.
import assert from "node:assert";
import { dice } from "../../tumato_symbolic/report/html/chance.mjs";
import { merged } from "../../tumato_symbolic/report/html/policy.mjs";
import { inside, upTo } from "../../tumato_symbolic/report/html/spec.mjs";

const chance = dice(5);
let states = 0;
let cubes = 0;
for (let n = 0; n < 200; n++) {
  const decided = new Map();
  for (const state of inside([3, 2, 4, 2].map(upTo))) {
    if (chance() < 0.8) decided.set(state.join(), [Math.floor(chance() * (state[0] ? 3 : 1.2))]);
  }
  const single = [...decided].map(([state, chosen]) => ({ values: state.split(",").map((value) => [Number(value)]), chosen, count: 1 }));
  const found = merged(single);
  const said = new Map();
  for (const { values, chosen, count } of found) {
    const held = [...inside(values)];
    assert.equal(held.length, count);
    for (const state of held) {
      assert(!said.has(state.join()));
      said.set(state.join(), chosen);
    }
  }
  assert.deepEqual(new Map([...said].sort()), new Map([...decided].sort()));
  states += single.length;
  cubes += found.length;
}
assert(cubes < 0.8 * states);

const product = [...inside(Array(12).fill(2).map(upTo))].map((state) => ({ values: state.map((value) => [value]), chosen: [state[3]], count: 1 }));
assert.deepEqual(merged(product).map(({ count }) => count), [2048, 2048]);
