// A specification as the page carries it: predicates become functions, states are arrays of value numbers.

// A predicate is true, false, [variable, value, …], ["x", action], ["!", p], ["&", …], ["|", …] or ["=", p, q].
export function compiled(predicate) {
  if (typeof predicate === "boolean") return () => predicate;
  const [head, ...rest] = predicate;
  if (typeof head === "number") {
    if (rest.length === 1) {
      const value = rest[0];
      return (state) => state[head] === value;
    }
    return (state) => rest.includes(state[head]);
  }
  if (head === "x") return (state, executed) => executed.includes(rest[0]);
  const parts = rest.map(compiled);
  if (head === "!") return (state, executed) => !parts[0](state, executed);
  if (head === "&") return (state, executed) => parts.every((part) => part(state, executed));
  if (head === "|") return (state, executed) => parts.some((part) => part(state, executed));
  return (state, executed) => parts[0](state, executed) === parts[1](state, executed);
}

const rule = (data) => ({ ...data, holds: compiled(data.is) });

function goalFrom(data) {
  if (data.body !== undefined) return data;
  if (data.when) return { when: rule(data.when), then: goalFrom(data.then) };
  return { kind: data.kind, members: data.members.map(goalFrom) };
}

const action = (data) => ({
  ...data,
  pre: data.pre.map(rule),
  cases: data.cases.map((one) => ({ ...one, meant: one.guard ? compiled(one.guard) : null })),
});

export function specFrom(data) {
  const sizes = data.variables.map(([, values]) => values.length);
  const rules = data.state_rules.map(rule);
  const severities = [...new Set(rules.map((each) => each.severity))].sort((a, b) => a - b);
  const tiers = severities.map((one) => rules.filter((each) => each.severity === one));
  return {
    ...data,
    names: data.variables.map(([name]) => name),
    values: data.variables.map(([, values]) => values),
    sizes,
    total: sizes.reduce((all, size) => all * size, 1),
    actions: data.actions.map(action),
    reaction_rules: data.reaction_rules.map(rule),
    state_rules: rules,
    assumptions: data.assumptions.map(rule),
    starts: data.starts.map(rule),
    bodies: data.bodies.map(rule),
    goals: data.goals === null ? null : goalFrom(data.goals),
    tiers: tiers.length ? tiers : [[]],
    stepwise: data.restoration !== "one_step" || tiers.length > 1,
    key: keyOf(sizes),
  };
}

// What tells states apart in a Map: their number, where numbers are exact, or their values.
function keyOf(sizes) {
  const total = sizes.reduce((all, size) => all * size, 1);
  if (total > Number.MAX_SAFE_INTEGER) return (state) => state.join();
  return (state) => {
    let number = 0;
    for (let n = 0; n < sizes.length; n++) number = number * sizes[n] + state[n];
    return number;
  };
}

export const upTo = (size) => [...Array(size).keys()];

// Every state of a cube (for each variable, the values that it may have), the last variable changing fastest.
export function* inside(values) {
  const at = values.map(() => 0);
  for (;;) {
    yield at.map((place, n) => values[n][place]);
    let n = at.length - 1;
    while (n >= 0 && ++at[n] === values[n].length) at[n--] = 0;
    if (n < 0) return;
  }
}

export const everyState = (spec) => inside(spec.sizes.map(upTo));

// A state by name, as files and traces have it: what is a whole number is a number there.
export function valuesOf(spec, state) {
  const written = (text) => (Number.isSafeInteger(Number(text)) && String(Number(text)) === text ? Number(text) : text);
  return Object.fromEntries(spec.names.map((name, n) => [name, written(spec.values[n][state[n]])]));
}
