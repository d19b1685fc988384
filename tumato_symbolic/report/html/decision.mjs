// What the policy does in a state, why, and what may come of it.
import { h, link } from "./dom.mjs";
import { fault } from "./judge.mjs";
import { activeGoals, run } from "./runs.mjs";
import { faultText, goalsIn, others, section } from "./state.mjs";
import { agree, duration, isSafe, level, objection, outcomes, successor } from "./steps.mjs";
import { actionsText, changeText, counted, ENDS, otherwise } from "./words.mjs";

// So many outcomes of a decision are listed beside the nominal one.
const MOST_OUTCOMES = 40;
// So many steps of the way back to safety are listed.
const MOST_BACK = 30;

export function decisionIn(app, state) {
  const { model, spec } = app;
  const chosen = model.decide(state);
  if (chosen === null) {
    const outside = spec.starts.length && model.assumed(state);
    return [h("p.decision", outside ? "Nothing is decided here: it is no start, and nothing that the policy does leads here from one." : "Nothing is decided here."), goalsIn(app, state)];
  }
  const wrong = fault(model, state, app.judge);
  return [h("p.decision", "do ", h("b", actionsText(spec, chosen)), chosen.length ? h("small", ` takes ${duration(spec, chosen)}`) : null),
    wrong ? h("p.bad", "✘ This page finds that this state ", faultText(app, wrong)) : h("p.quiet", "✔ checked by this page"),
    goalsIn(app, state),
    objection(model, state, chosen) ? null : section("Run, if effects are as intended", nominalRun(app, run(model, state, chosen))),
    section("What may happen", outcomeList(app, state, chosen)),
    spec.stepwise && !isSafe(model, state) ? section("Way to safety", wayToSafety(app, state, chosen)) : null,
    section("Why nothing else?", others(app, state, chosen))];
}

function nominalRun(app, { states, decisions, end }) {
  return [h("ol", decisions.map((chosen, n) => h("li",
    link(app, actionsText(app.spec, chosen), states[n], `r${n}`), ` → ${changeText(app.spec, states[n], states[n + 1])}`))),
  h("p", { class: end === "goal" ? "good" : "bad" }, `After ${counted(decisions.length, "step")} ${endText(app, states[0], end)}.`)];
}

// How a run ends; what is unsafe is restored on the way.
function endText({ spec, model }, state, end) {
  if (end !== "goal" || !spec.stepwise || isSafe(model, state)) return ENDS[end];
  const nothingElse = activeGoals(spec, state).every((body) => spec.bodies[body].is === true);
  return nothingElse ? "safety is restored" : `safety is restored and ${ENDS[end]}`;
}

function outcomeList(app, state, chosen) {
  const { spec, model } = app;
  if (!agree(spec, state, chosen)) return h("p.bad", "Its effects contradict each other.");
  const end = successor(spec, state, chosen);
  const rest = outcomes(spec, state, chosen).filter((each) => spec.key(each.state) !== spec.key(end));
  const line = (words, after, text, n) => h("li", words, link(app, text, after, `o${n}`), isSafe(model, after) ? "" : h("b.bad", " unsafe"));
  return h("ul", line("as intended: ", end, changeText(spec, state, end), 0),
    rest.slice(0, MOST_OUTCOMES).map((each, n) => line("or it may instead: ", each.state, otherwise(spec, state, chosen, each), n + 1)),
    rest.length > MOST_OUTCOMES ? h("li", `and ${rest.length - MOST_OUTCOMES} more`) : null);
}

// How well the decision restores safety, and the nominal run until it is restored.
function wayToSafety(app, state, chosen) {
  const { spec, model } = app;
  const quality = app.judge.restorations.quality(state, chosen);
  if (!quality) return h("p.bad", "It need not end in safety.");
  const [kind, lasting, steps] = quality;
  const better = spec.tiers.length > 1 ? `the rules of severity ${spec.tiers[level(model, state)][0].severity} hold again` : "safety is restored";
  const most = kind === 2 ? "" : "at most ";
  const words = `${most ? "Whatever happens" : "If effects are as intended"}, ${better} after ${most}${counted(steps, "step")}, which take ${most}${lasting} in all.`;
  const list = [];
  let here = state;
  while (!isSafe(model, here) && list.length < MOST_BACK) {
    const does = model.decide(here);
    if (does === null || !agree(spec, here, does)) break;
    const next = successor(spec, here, does);
    list.push(h("li", `${actionsText(spec, does)} → ${changeText(spec, here, next)}`));
    here = next;
  }
  return [h("p", words), h("ol", list)];
}
