// How a policy restores safety where that may take several steps (docs/semantics.md, sections 9 and 10).
import { agree, duration, isSafe, isValid, level, nextStates, successor } from "./steps.mjs";

export const smaller = (one, other) => {
  const n = one.findIndex((each, at) => each !== other[at]);
  return n >= 0 && one[n] < other[n];
};

const longer = ([lasting, steps], more) => [lasting + more, steps + 1];

// Whether a tier of state rules more holds than before.
export const restored = (model, state, after) => isValid(model, after) && level(model, after) > level(model, state);

export class Restorations {
  // `most` bounds how many unsafe states are looked at; `whole` tells whether that was enough.
  constructor(model, most = Infinity) {
    this.model = model;
    this.most = most;
    this.worst = new Map();
    this.met = new Set();
    this.whole = true;
  }

  // Learn the worst effort of all unsafe states that the policy can come to from these.
  visit(states) {
    const { spec } = this.model;
    const open = new Map();
    const after = new Map();
    const pending = [...states];
    while (pending.length) {
      const state = pending.pop();
      const key = spec.key(state);
      if (this.met.has(key) || isSafe(this.model, state)) continue;
      if (this.met.size >= this.most) {
        this.whole = false;
        return;
      }
      this.met.add(key);
      const chosen = this.model.decide(state);
      if (chosen === null || !agree(spec, state, chosen)) continue;
      const left = nextStates(spec, state, chosen).filter((each) => !restored(this.model, state, each));
      open.set(key, { lasting: duration(spec, chosen), left: left.map(spec.key), unknown: 0 });
      pending.push(...left);
    }
    const ready = [];
    for (const [key, each] of open) {
      for (const next of each.left) {
        if (this.worst.has(next)) continue;
        each.unknown += 1;
        if (!after.has(next)) after.set(next, []);
        after.get(next).push(key);
      }
      if (!each.unknown) ready.push(key);
    }
    while (ready.length) {
      const key = ready.pop();
      const { lasting, left } = open.get(key);
      this.worst.set(key, longer(this.largest(left), lasting));
      for (const before of after.get(key) ?? []) if (!--open.get(before).unknown) ready.push(before);
    }
  }

  largest(keys) {
    return keys.reduce((most, key) => (smaller(most, this.worst.get(key)) ? this.worst.get(key) : most), [0, 0]);
  }

  // How well a set restores an unsafe state that then follows the policy: [kind, duration, steps], the smaller the
  // better; null where it restores nothing. In one step is 0, in more 1, and 2 only if nominal effects recur.
  quality(state, chosen) {
    const { spec } = this.model;
    const left = nextStates(spec, state, chosen).filter((each) => !restored(this.model, state, each));
    this.visit(left);
    const keys = left.map(spec.key);
    if (keys.every((key) => this.worst.has(key))) {
      return [keys.length ? 1 : 0, ...longer(this.largest(keys), duration(spec, chosen))];
    }
    if (spec.restoration !== "fair") return null;
    const found = this.nominal(state, chosen);
    return found && [2, ...found];
  }

  // The efforts along the nominal run until a tier more holds; null where none ever does.
  nominal(state, chosen) {
    const { spec } = this.model;
    const seen = new Set();
    let effort = [0, 0];
    let here = state;
    let executed = chosen;
    while (!seen.has(spec.key(here)) && executed !== null && agree(spec, here, executed)) {
      seen.add(spec.key(here));
      effort = longer(effort, duration(spec, executed));
      here = successor(spec, here, executed);
      if (restored(this.model, state, here)) return effort;
      executed = spec.key(here) === spec.key(state) ? chosen : this.model.decide(here);
    }
    return null;
  }
}
