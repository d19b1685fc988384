// States that fail, looked at without a policy (docs/semantics.md, sections 7 and 9): what takes long is a generator, which
// yields now and then, so that it can be done a little at a time.
import { restored } from "./restoring.mjs";
import { activeGoals, reached, residual } from "./runs.mjs";
import { everyState } from "./spec.mjs";
import { allowedSets, isSafe, isValid, modelOf, nextStates, successor } from "./steps.mjs";

// Thrown where more would have to be looked at than is allowed.
export const TOO_MUCH = new Error("too much to look at");

// The actions of which a predicate says something.
const named = (is) => (!Array.isArray(is) || typeof is[0] === "number" ? [] : is[0] === "x" ? [is[1]] : is.slice(1).flatMap(named));

export class Alone {
  // `budget.left` bounds how many sets of actions are tried in all.
  constructor(model, budget) {
    this.model = model;
    this.budget = budget;
    this.known = new Map();
    this.region = new Map();
    this.named = model.spec.bodies.map((body) => named(body.is));
    this.several = model.spec.restoration !== "one_step";
  }

  // The allowed sets in a state, of those that lead to the same ones only the first: where each leads, what it leaves of the
  // goals, and what it does not restore.
  options(state) {
    const { model, budget, known } = this;
    const { spec } = model;
    const key = spec.key(state);
    if (known.has(key)) return known.get(key);
    const found = new Map();
    const mentioned = activeGoals(spec, state).flatMap((body) => this.named[body]);
    const safe = isSafe(model, state);
    for (const chosen of allowedSets(model, state, Infinity, budget)) {
      const after = successor(spec, state, chosen);
      const open = safe ? [] : (spec.restoration === "fair" ? [after] : nextStates(spec, state, chosen)).filter((each) => !restored(model, state, each));
      const name = [spec.key(after), chosen.filter((each) => mentioned.includes(each)), open.map(spec.key).sort()].join(";");
      if (!found.has(name)) found.set(name, { chosen, after, open });
    }
    if (budget.left < 0) throw TOO_MUCH;
    known.set(key, [...found.values()]);
    return known.get(key);
  }

  // Whether an unsafe state can be led to where a tier of rules more holds.
  *restorable(state) {
    const { key } = this.model.spec;
    if (!this.region.has(key(state))) {
      const met = new Map();
      const pending = [state];
      while (pending.length) {
        const here = pending.pop();
        if (met.has(key(here)) || this.region.has(key(here))) continue;
        met.set(key(here), this.options(here));
        pending.push(...met.get(key(here)).flatMap(({ open }) => open));
        yield;
      }
      for (let more = true; more;) {
        more = false;
        for (const [each, options] of met) {
          if (this.region.get(each) || !options.some(({ open }) => open.every((next) => this.region.get(key(next))))) continue;
          this.region.set(each, true);
          more = true;
        }
        yield;
      }
      for (const each of met.keys()) if (!this.region.has(each)) this.region.set(each, false);
    }
    return this.region.get(key(state));
  }

  // The options that a run to a goal may take.
  *passable(state) {
    const { model } = this;
    const { key } = model.spec;
    const options = this.options(state);
    if (model.spec.restoration !== "bounded" || isSafe(model, state)) return options;
    const found = [];
    for (const option of options) {
      let fits = option.open.every((each) => key(each) !== key(state));
      for (const each of option.open) fits &&= yield* this.restorable(each);
      if (fits) found.push(option);
    }
    return found;
  }

  // Why a valid state fails, taken alone; null where it does not.
  *kind(state) {
    const { model } = this;
    const safe = isSafe(model, state);
    if (!this.options(state).length && (safe || !this.several)) return "no-allowed-set";
    if (this.several && !safe && !(yield* this.restorable(state))) return "no-restoration";
    return (yield* this.reaches(state)) ? null : "no-plan";
  }

  // Whether some run from a state meets its goal within the bound.
  *reaches(state) {
    const { model } = this;
    const { spec } = model;
    const mentioned = activeGoals(spec, state).flatMap((body) => this.named[body]);
    const groups = new Map();
    for (const { chosen, after } of yield* this.passable(state)) {
      const name = chosen.filter((each) => mentioned.includes(each)).join();
      if (!groups.has(name)) groups.set(name, { goal: residual(spec, state, chosen), here: [] });
      groups.get(name).here.push(after);
    }
    for (const { goal, here } of groups.values()) {
      const seen = new Set();
      let layer = here;
      for (let steps = 1; layer.length && steps <= (spec.bound ?? Infinity); steps++) {
        const next = [];
        for (const each of layer) {
          if (reached(model, goal, each)) return true;
          if (seen.has(spec.key(each))) continue;
          seen.add(spec.key(each));
          for (const { after } of yield* this.passable(each)) next.push(after);
          yield;
        }
        layer = next;
      }
    }
    return false;
  }

  // Whether one choice for every state lets the runs of all these states meet their goals.
  *together(states, chosen = new Map(), at = 0) {
    if (at === states.length) return true;
    const { spec } = this.model;
    const start = states[at];
    const first = chosen.get(spec.key(start));
    const goal = first && residual(spec, start, first.chosen);
    let here = start;
    const seen = new Set();
    for (let steps = 0; ; steps++) {
      if (steps && reached(this.model, goal, here)) return yield* this.together(states, chosen, at + 1);
      if (steps === spec.bound || seen.has(spec.key(here))) return false;
      seen.add(spec.key(here));
      const option = chosen.get(spec.key(here));
      if (!option) break;
      here = option.after;
    }
    for (const option of yield* this.passable(here)) {
      if (this.budget.left-- <= 0) throw TOO_MUCH;
      yield;
      if (yield* this.together(states, new Map(chosen).set(spec.key(here), option), at)) return true;
    }
    return false;
  }
}

// The keys of the valid states that no policy from the starts can decide, goals that conflict aside (section 12): those that
// fail where only the others may be met.
export function* lostStates(spec, most) {
  const lost = new Set();
  const model = modelOf(spec, { at: (state) => (lost.has(spec.key(state)) ? null : []) });
  const budget = { left: most };
  for (let before = -1; before < lost.size;) {
    before = lost.size;
    const alone = new Alone(model, budget);
    for (const state of everyState(spec)) {
      if (isValid(model, state) && (yield* alone.kind(state)) !== null) lost.add(spec.key(state));
      yield;
    }
  }
  return lost;
}

// Whether some elements suffice for what is said of a state (of a conflict: of several), and do not without any one of them.
export function* coreHolds(spec, alternatives, { kind, elements, states }, most) {
  const holds = function* (kept) {
    const alone = new Alone(modelOf(keepOnly(spec, alternatives, kept), { at: () => null }), { left: most });
    if (kind === "conflict") return !(yield* alone.together(states));
    if (kind === "no-allowed-set") return !alone.options(states[0]).length;
    return !(yield* kind === "no-plan" ? alone.reaches(states[0]) : alone.restorable(states[0]));
  };
  if (!(yield* holds(elements))) return false;
  for (const one of elements) if (yield* holds(elements.filter((each) => each !== one))) return false;
  return true;
}

// The specification with every element dropped that is not kept. An element is [kind, number, part], as the page names them;
// `alternatives` has, for each case of each action, the numbers of the effects of every alternative.
function keepOnly(spec, alternatives, kept) {
  const names = new Set(kept.map(String));
  const has = (...element) => names.has(String(element));
  const rules = (kind, all) => all.filter((_, n) => has(kind, n, 0));
  const actions = spec.actions.map((action, number) => ({
    ...action,
    resources: action.resources.filter((each) => has("resource", number, each)),
    pre: action.pre.filter((_, n) => has("precondition", number, n)),
    cases: action.cases.map((one, at) => ({ ...one, effects: keptEffects(one.effects, alternatives[number][at].filter((_, n) => has("alternative", number, n))) })),
  }));
  const state_rules = rules("state-rule", spec.state_rules);
  return {
    ...spec, actions, state_rules, tiers: [state_rules],
    reaction_rules: rules("reaction-rule", spec.reaction_rules),
    assumptions: rules("assumption", spec.assumptions),
    bound: has("plan-bound", 0, 0) ? spec.bound : null,
  };
}

// The nominal effects, which stand first, and those of some alternatives.
function keptEffects(effects, alternatives) {
  const found = effects.filter((_, n) => n === 0 || alternatives.flat().includes(n));
  return found.some((effect) => effect.length) ? found : [];
}
