// Executions by chance (docs/run.md): random numbers, which effects happen in which order, what the environment does.
import { agree, applied, effectsIn, isValid, successor } from "./steps.mjs";
import { reached, residual } from "./runs.mjs";

// Numbers from 0 to below 1, the same ones for the same seed (mulberry32).
export function dice(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let mixed = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 4294967296;
  };
}

const oneOf = (list, chance) => list[Math.floor(chance() * list.length)];

function shuffled(list, chance) {
  const found = list.slice();
  for (let n = found.length - 1; n > 0; n--) {
    const other = Math.floor(chance() * (n + 1));
    [found[n], found[other]] = [found[other], found[n]];
  }
  return found;
}

// One outcome of a set, all of them being possible: { state, way }, way being null for the nominal one.
export function randomMove(spec, state, chosen, chance) {
  const nominal = successor(spec, state, chosen);
  const effects = new Map(chosen.map((number) => [number, effectsIn(spec, number, state)]));
  let acting = shuffled(chosen.filter((number) => effects.get(number).length), chance);
  if (spec.ordering === "any") acting = acting.slice(0, acting.length && 1 + Math.floor(chance() * acting.length));
  else acting = acting.length < 2 || chance() < 0.5 ? acting.slice(0, 1) : [];
  const way = [];
  let after = state;
  for (const action of acting) {
    const effect = oneOf(effects.get(action), chance);
    after = applied(effect, after);
    way.push({ action, effect });
  }
  return !way.length || spec.key(after) === spec.key(nominal) ? { state: nominal, way: null } : { state: after, way };
}

// A valid state that differs in one variable; null where there is none.
export function disturbed(model, state, chance) {
  const changes = model.spec.sizes.flatMap((size, n) => upTo(size).map((value) => [n, value]));
  const wanted = shuffled(changes.filter(([n, value]) => state[n] !== value), chance);
  return wanted.map((change) => applied(change, state)).find((each) => isValid(model, each)) ?? null;
}

// From a state until its goal is met, or nothing more can come: events as { state, chosen, way }, and how it ended. What
// has no `chosen` is a disturbance; after one, the goals are those of the state that it led to.
export function execution(model, start, { faults, disturb, most }, chance) {
  const { spec } = model;
  const events = [];
  const met = new Set([spec.key(start)]);
  let here = start;
  let goal = null;
  while (events.length < most) {
    const chosen = model.decide(here);
    if (chosen === null || !agree(spec, here, chosen)) return { start, events, end: "undefined" };
    goal ??= residual(spec, here, chosen);
    const { state, way } = faults ? randomMove(spec, here, chosen, chance) : { state: successor(spec, here, chosen), way: null };
    events.push({ state, chosen, way });
    here = state;
    if (reached(model, goal, here)) return { start, events, end: "goal" };
    if (!faults && !disturb) {
      if (met.has(spec.key(here))) return { start, events, end: "loop" };
      met.add(spec.key(here));
    }
    const after = disturb && chance() < disturb ? disturbed(model, here, chance) : null;
    if (after) {
      events.push({ state: after, chosen: null, way: null });
      here = after;
      goal = null;
    }
  }
  return { start, events, end: "bound" };
}
