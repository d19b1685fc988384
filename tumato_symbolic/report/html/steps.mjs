// Single steps: what may be executed together, and where it leads (docs/semantics.md, sections 1 to 3, 9 and 10).
// A model is a specification with `decide(state)`, what the policy executes in a valid state, or null.

export function modelOf(spec, decisions) {
  const assumed = (state) => spec.assumptions.every((rule) => rule.holds(state, []));
  const inPart = { text: "the policy decides it", holds: (state) => decisions.at(state) !== null };
  const validity = spec.starts.length ? [...spec.assumptions, inPart] : spec.assumptions;
  return {
    spec,
    validity,
    inPart,
    assumed,
    given: decisions.at,
    decide: (state) => (assumed(state) ? decisions.at(state) : null),
    isStart: (state) => !spec.starts.length || spec.starts.some((rule) => rule.holds(state, [])),
  };
}

const broken = (rules, state) => rules.find((rule) => !rule.holds(state, [])) ?? null;

export const isValid = (model, state) => broken(model.validity, state) === null;

export const isSafe = (model, state) => isValid(model, state) && broken(model.spec.state_rules, state) === null;

// How many tiers of state rules hold whole, the most severe first.
export function level(model, state) {
  const found = model.spec.tiers.findIndex((tier) => broken(tier, state) !== null);
  return found < 0 ? model.spec.tiers.length : found;
}

// What every state has to satisfy that a step from this one leads to.
function required(model, state) {
  const { spec } = model;
  const concerned = spec.tiers.slice(0, level(model, state) + 1).flat();
  const kept = spec.restoration === "one_step" ? concerned : concerned.filter((rule) => rule.holds(state, []));
  return [...model.validity, ...kept];
}

// The case of an action that is meant in a state: the first one where none is.
function caseIn(action, state) {
  return action.cases.find((one) => !one.meant || one.meant(state)) ?? null;
}

export const effectsIn = (spec, number, state) =>
  (caseIn(spec.actions[number], state) ?? spec.actions[number].cases[0]).effects;

export function applied(effect, state) {
  const after = state.slice();
  for (let n = 0; n < effect.length; n += 2) after[effect[n]] = effect[n + 1];
  return after;
}

const nominal = (effects) => effects[0] ?? [];

// Whether no variable is given two values by nominal effects.
export function agree(spec, state, chosen) {
  const written = new Map();
  for (const number of chosen) {
    const effect = nominal(effectsIn(spec, number, state));
    for (let n = 0; n < effect.length; n += 2) {
      if ((written.get(effect[n]) ?? effect[n + 1]) !== effect[n + 1]) return false;
      written.set(effect[n], effect[n + 1]);
    }
  }
  return true;
}

export function successor(spec, state, chosen) {
  return chosen.reduce((after, number) => applied(nominal(effectsIn(spec, number, state)), after), state);
}

// The states that effects lead to, the shortest ways first: each with who is still waiting, and the way to it.
// The conditions of effects are read where the actions start.
function* ways(spec, state, chosen) {
  const effects = new Map(chosen.map((number) => [number, effectsIn(spec, number, state)]));
  const seen = new Set();
  let frontier = [{ state, waiting: chosen, way: [] }];
  while (frontier.length) {
    const following = [];
    for (const here of frontier) {
      for (const number of here.waiting) {
        const waiting = here.waiting.filter((each) => each !== number);
        for (const effect of effects.get(number)) {
          const after = applied(effect, here.state);
          const name = `${spec.key(after)};${waiting}`;
          if (seen.has(name)) continue;
          seen.add(name);
          const next = { state: after, waiting, way: [...here.way, { action: number, effect }] };
          following.push(next);
          yield next;
        }
      }
    }
    frontier = spec.ordering === "any" ? following : [];
  }
}

// Out(s, A): every state that the step can lead to, each with a shortest way.
export function outcomes(spec, state, chosen) {
  if (chosen.every((number) => !effectsIn(spec, number, state).length)) return [{ state, way: [] }];
  const found = new Map();
  for (const each of ways(spec, state, chosen)) {
    const key = spec.key(each.state);
    if (!found.has(key)) found.set(key, each);
  }
  return [...found.values()];
}

// Next(s, A): every state in which the next decision may be taken.
export function nextStates(spec, state, chosen) {
  const found = new Map(outcomes(spec, state, chosen).map((each) => [spec.key(each.state), each.state]));
  const end = successor(spec, state, chosen);
  found.set(spec.key(end), end);
  return [...found.values()];
}

// Why two actions are never executed together: one that is in a set beside another.
function clash(spec, state, chosen) {
  for (let i = 0; i < chosen.length; i++) {
    for (let j = i + 1; j < chosen.length; j++) {
      const pair = [chosen[i], chosen[j]];
      const shared = spec.actions[pair[0]].resources.filter((each) => spec.actions[pair[1]].resources.includes(each));
      if (shared.length) return { kind: "resource", actions: pair, resource: shared[0] };
      if (!agree(spec, state, pair)) return { kind: "nominal-conflict", actions: pair };
    }
  }
  return null;
}

// Why an action may not start, whatever else is executed.
function notApplicable(spec, state, number) {
  const found = broken(spec.actions[number].pre, state);
  if (found) return { kind: "precondition", actions: [number], rule: found };
  return caseIn(spec.actions[number], state) ? null : { kind: "precondition", actions: [number], rule: null };
}

// The first condition that a set of actions does not meet; null where it is allowed.
export function objection(model, state, chosen) {
  const { spec } = model;
  for (const number of chosen) {
    const found = notApplicable(spec, state, number);
    if (found) return found;
  }
  const found = clash(spec, state, chosen);
  if (found) return found;
  const rule = spec.reaction_rules.find((each) => !each.holds(state, chosen));
  if (rule) return { kind: "reaction-rule", actions: chosen, rule };
  const wanted = required(model, state);
  for (const each of outcomes(spec, state, chosen)) {
    const fault = broken(wanted, each.state);
    if (fault) return { kind: "unsafe", actions: chosen, rule: fault, way: each.way, state: each.state };
  }
  if (spec.preconditions === "throughout") {
    for (const each of ways(spec, state, chosen)) {
      for (const number of each.waiting) {
        const fault = broken(spec.actions[number].pre, each.state);
        if (fault) return { kind: "falsified", actions: [number], rule: fault, way: each.way, state: each.state };
      }
    }
  }
  const end = successor(spec, state, chosen);
  const fault = broken(wanted, end);
  return fault ? { kind: "nominal-unsafe", actions: chosen, rule: fault, way: [], state: end } : null;
}

// Every allowed set of at most `most` duration, smaller sets first; `budget.left` is how many sets may be looked at. What
// effects of some actions break is broken whatever is executed beside them.
export function* allowedSets(model, state, most = Infinity, budget = { left: Infinity }) {
  const { spec } = model;
  const lasts = (number) => spec.actions[number].duration;
  const able = spec.actions.map((_, number) => number).filter((number) => !notApplicable(spec, state, number));
  let sets = [{ chosen: [], lasting: 0, next: 0 }];
  while (sets.length) {
    const larger = [];
    for (const { chosen, lasting, next } of sets) {
      if (budget.left-- <= 0) return;
      const found = objection(model, state, chosen);
      if (!found) yield chosen;
      if (found?.way?.length) continue;
      for (let n = next; n < able.length; n++) {
        const more = { chosen: [...chosen, able[n]], lasting: lasting + lasts(able[n]), next: n + 1 };
        if (more.lasting <= most && !clash(spec, state, more.chosen)) larger.push(more);
      }
    }
    sets = larger;
  }
}

export const duration = (spec, chosen) => chosen.reduce((all, number) => all + spec.actions[number].duration, 0);
