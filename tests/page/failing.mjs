// What the page finds without a policy, for tests. On every line in a JSON object with `spec`, and maybe `alternatives`,
// `cores` ({ kind, elements, states }, …) and `conflicts` (lists of states); on every line out why each valid state fails, which
// cores hold, which states can be served together, and with starts, which cannot be decided.
import { createInterface } from "node:readline";
import { Alone, coreHolds, lostStates } from "../../tumato_symbolic/report/html/failing.mjs";
import { everyState, specFrom } from "../../tumato_symbolic/report/html/spec.mjs";
import { isValid, modelOf } from "../../tumato_symbolic/report/html/steps.mjs";

function result(work) {
  for (;;) {
    const { value, done } = work.next();
    if (done) return value;
  }
}

for await (const line of createInterface({ input: process.stdin })) {
  const { spec: data, alternatives, cores = [], conflicts = [] } = JSON.parse(line);
  const spec = specFrom({ ...data, starts: [] });
  const model = modelOf(spec, { at: () => null });
  const alone = new Alone(model, { left: 10_000_000 });
  const whole = specFrom(data);
  const lost = whole.starts.length ? result(lostStates(whole, 10_000_000)) : new Set();
  console.log(JSON.stringify({
    lost: [...everyState(spec)].filter((state) => lost.has(spec.key(state))),
    kinds: [...everyState(spec)].filter((state) => isValid(model, state)).map((state) => [state, result(alone.kind(state))]),
    cores: cores.map((core) => result(coreHolds(spec, alternatives, core, 10_000_000))),
    served: conflicts.map((states) => result(alone.together(states))),
  }));
}
