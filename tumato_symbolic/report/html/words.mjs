// How the page words numbers, actions, effects, states and objections.

export const grouped = (number) => BigInt(number).toLocaleString("en-US");

export const counted = (number, noun) => `${grouped(number)} ${noun}${BigInt(number) === 1n ? "" : "s"}`;

// Of null: that nothing is decided.
export const actionsText = (spec, chosen) =>
  !chosen ? "not decided" : chosen.length ? chosen.map((number) => spec.actions[number].name).join(", ") : "nothing";

// The same, but of many actions the first ones only.
export const shortText = (spec, chosen) =>
  chosen?.length > 4 ? `${actionsText(spec, chosen.slice(0, 3))} and ${chosen.length - 3} more` : actionsText(spec, chosen);

export const effectText = (spec, effect) => {
  const parts = [];
  for (let n = 0; n < effect.length; n += 2) parts.push(`${spec.names[effect[n]]} is ${spec.values[effect[n]][effect[n + 1]]}`);
  return parts.join(", ") || "no change";
};

export function changeText(spec, before, after) {
  return effectText(spec, after.flatMap((value, n) => (value === before[n] ? [] : [n, value])));
}

// How effects happen, one after the other.
export const wayText = (spec, way) =>
  way.map(({ action, effect }) => `${spec.actions[action].name}: ${effectText(spec, effect)}`).join(", then ");

// What happens where effects are not as intended.
export const otherwise = (spec, state, chosen, each) => (chosen.length > 1 ? wayText(spec, each.way) : changeText(spec, state, each.state));

export const stateText = (spec, state) => state.map((value, n) => `${spec.names[n]}=${spec.values[n][value]}`).join(" ");

// The values of a cube that are not all values, as [variable, text, number of values].
export function conditionsOf(spec, values) {
  return values.flatMap((some, n) => {
    const others = spec.values[n].filter((_, value) => !some.includes(value));
    if (!others.length) return [];
    if (some.length === 1) return [`${spec.names[n]} is ${spec.values[n][some[0]]}`];
    if (others.length === 1) return [`${spec.names[n]} is not ${others[0]}`];
    return [`${spec.names[n]} in {${some.map((value) => spec.values[n][value]).join(", ")}}`];
  });
}

// Why a set is not allowed: a sentence, and the rule that it speaks of.
export function objectionText(spec, found) {
  const [first, second] = found.actions.map((number) => spec.actions[number].name);
  const happens = found.way?.length ? `if ${wayText(spec, found.way)}, then` : "then";
  switch (found.kind) {
    case "precondition":
      return found.rule ? [`${first} needs`, found.rule] : [`no condition of ${first} holds`, null];
    case "resource":
      return [`${first} and ${second} both use ${spec.resources[found.resource]}`, null];
    case "nominal-conflict":
      return [`the effects of ${first} and ${second} contradict each other`, null];
    case "reaction-rule":
      return ["forbidden by", found.rule];
    case "falsified":
      return [`${happens} ${first} lacks`, found.rule];
    case "nominal-unsafe":
      return ["after all effects together, this is broken:", found.rule];
    default:
      return [found.way.length ? `${happens} this is broken:` : "it changes nothing, and this stays broken:", found.rule];
  }
}

export const ENDS = {
  goal: "the goal is met",
  bound: "the goal is not met within the bound",
  loop: "it goes round in circles without meeting the goal",
  undefined: "it comes to where nothing is decided",
};
