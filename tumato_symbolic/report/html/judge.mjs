// The judgement of a policy, one state at a time: an implementation of its own, which asks nobody else.
import { run } from "./runs.mjs";
import { Restorations, smaller } from "./restoring.mjs";
import { everyState } from "./spec.mjs";
import { agree, allowedSets, duration, isSafe, objection, successor } from "./steps.mjs";

// What is wrong with what is decided in a state, as [property, detail]; null where nothing is.
export function fault(model, state, judge) {
  if (!model.assumed(state)) return model.spec.starts.length && model.given(state) !== null ? ["invalid", null] : null;
  const chosen = model.decide(state);
  if (chosen === null) return model.isStart(state) ? ["total", null] : null;
  const found = objection(model, state, chosen);
  if (found) return ["safe", found];
  const safe = isSafe(model, state);
  if (!safe && model.spec.stepwise && judge.restorations.quality(state, chosen) === null) return ["restoring", null];
  const made = run(model, state, chosen);
  if (made.end !== "goal") return ["goals", made];
  const better = safe ? null : judge.better(state);
  return better ? ["minimal", better] : null;
}

export class Judge {
  // `most` bounds how many unsafe states, and how many sets in one state, are looked at; `unfinished` counts where that
  // was not enough to tell whether a decision is minimal.
  constructor(model, most = Infinity) {
    this.model = model;
    this.most = most;
    this.restorations = new Restorations(model, most);
    this.before = null;
    this.unfinished = 0;
  }

  // An allowed set that restores an unsafe state better, and serves as well; null where there is none.
  better(state) {
    const { model, restorations } = this;
    const { spec } = model;
    const today = model.decide(state);
    const budget = { left: this.most };
    if (!spec.stepwise) {
      for (const other of allowedSets(model, state, duration(spec, today) - 1, budget)) {
        if (run(model, state, other).end === "goal") return other;
      }
    } else {
      const now = agree(spec, state, today) ? restorations.quality(state, today) : null;
      for (const other of allowedSets(model, state, Infinity, budget)) {
        const then = restorations.quality(state, other);
        if (then && (!now || smaller(then, now)) && this.serves(state, other)) return other;
      }
    }
    if (budget.left < 0) this.unfinished += 1;
    return null;
  }

  // Whether, with another set in a state, its run meets its goal, and all others still do that do now.
  serves(state, other) {
    const { model } = this;
    const here = model.spec.key(state);
    const decide = (each) => (model.spec.key(each) === here ? other : model.decide(each));
    if (run(model, state, other, decide).end !== "goal") return false;
    return this.through(state).every((each) => {
      const first = model.decide(each);
      return run(model, each, first).end !== "goal" || run(model, each, first, decide).end === "goal";
    });
  }

  // The other states whose nominal runs come through this one.
  through(state) {
    const { key } = this.model.spec;
    this.before ??= this.predecessors();
    const seen = new Set([key(state)]);
    const found = [];
    const pending = [state];
    while (pending.length) {
      for (const each of this.before.get(key(pending.pop())) ?? []) {
        if (seen.has(key(each))) continue;
        seen.add(key(each));
        found.push(each);
        pending.push(each);
      }
    }
    return found;
  }

  predecessors() {
    const { spec, decide } = this.model;
    const before = new Map();
    for (const state of everyState(spec)) {
      const chosen = decide(state);
      if (chosen === null || !agree(spec, state, chosen)) continue;
      const after = spec.key(successor(spec, state, chosen));
      if (!before.has(after)) before.set(after, []);
      before.get(after).push(state);
    }
    return before;
  }
}

// All that is wrong with a policy: states by what is wrong. For a small number of states.
export function judgement(model) {
  const { spec } = model;
  const judge = new Judge(model);
  const found = { missing: [], invalid: [], not_allowed: [], goal_missed: [], not_minimal: [], not_restored: [] };
  let longest = 0;
  for (const state of everyState(spec)) {
    const chosen = model.decide(state);
    if (chosen === null) {
      if (model.assumed(state) && model.isStart(state)) found.missing.push(state);
      if (spec.starts.length && !model.assumed(state) && model.given(state) !== null) found.invalid.push(state);
      continue;
    }
    const safe = isSafe(model, state);
    const objected = objection(model, state, chosen);
    if (objected) found.not_allowed.push([state, objected.kind]);
    else {
      const made = run(model, state, chosen);
      if (made.end !== "goal") found.goal_missed.push([state, made.end]);
      else longest = Math.max(longest, made.decisions.length);
    }
    if (safe) continue;
    if (judge.better(state)) found.not_minimal.push(state);
    if (spec.stepwise && agree(spec, state, chosen) && judge.restorations.quality(state, chosen) === null) {
      found.not_restored.push(state);
    }
  }
  return { ...found, longest_run: longest };
}
