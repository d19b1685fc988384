// Goals and nominal runs (docs/semantics.md, sections 4 and 5).
import { agree, isSafe, successor } from "./steps.mjs";

function walk(goal, state) {
  if (goal.body !== undefined) return { entered: true, active: [goal] };
  if (goal.when) {
    return goal.when.holds(state, []) ? { entered: true, active: walk(goal.then, state).active } : { entered: false, active: [] };
  }
  const active = [];
  for (const member of goal.members) {
    const found = walk(member, state);
    active.push(...found.active);
    if (found.entered && goal.kind === "priority") break;
  }
  return { entered: true, active };
}

const active = (spec, state) => (spec.goals ? walk(spec.goals, state).active : []);

// The numbers of the goal bodies that are active in a state.
export const activeGoals = (spec, state) => [...new Set(active(spec, state).map(({ body }) => body))].sort((a, b) => a - b);

// The goals that are active in a state, each with its own text and place: several may have one body.
export const writtenGoals = (spec, state) => active(spec, state).map((goal) => ({ ...spec.bodies[goal.body], with: null, ...goal }));

// What is left of the goals of a state once its first set is chosen.
export const residual = (spec, state, first) => ({ bodies: activeGoals(spec, state), first });

export function reached(model, goal, state) {
  if (model.spec.stepwise && !isSafe(model, state)) return false;
  return goal.bodies.every((body) => model.spec.bodies[body].holds(state, goal.first));
}

// The run that executes `first` in `start` and then what `decide` says: until the goal is met, or cannot be any more.
export function run(model, start, first, decide = model.decide) {
  const { spec } = model;
  const goal = residual(spec, start, first);
  const states = [start];
  const decisions = [first];
  const met = new Set();
  for (;;) {
    const here = successor(spec, states.at(-1), decisions.at(-1));
    states.push(here);
    const ended = (end) => ({ states, decisions, end });
    if (reached(model, goal, here)) return ended("goal");
    if (decisions.length === spec.bound) return ended("bound");
    if (met.has(spec.key(here))) return ended("loop");
    const chosen = decide(here);
    if (chosen === null || !agree(spec, here, chosen)) return ended("undefined");
    met.add(spec.key(here));
    decisions.push(chosen);
  }
}
