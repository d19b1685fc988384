// What the policy does in a state, why, and what may come of it.
import { h, link } from "./dom.mjs";
import { fault } from "./judge.mjs";
import { run } from "./runs.mjs";
import { faultText, goalsIn, others, section } from "./state.mjs";
import { agree, duration, isSafe, objection, outcomes, successor } from "./steps.mjs";
import { actionsText, changeText, counted, ENDS, wayText } from "./words.mjs";

const MOST_OUTCOMES = 40;

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
  h("p", { class: end === "goal" ? "good" : "bad" }, `After ${counted(decisions.length, "step")} ${ENDS[end]}.`)];
}

function outcomeList(app, state, chosen) {
  const { spec, model } = app;
  if (!agree(spec, state, chosen)) return h("p.bad", "Its effects contradict each other.");
  const end = successor(spec, state, chosen);
  const rest = outcomes(spec, state, chosen).filter((each) => spec.key(each.state) !== spec.key(end));
  const line = (after, words, n) => h("li", link(app, changeText(spec, state, after), after, `o${n}`), words, isSafe(model, after) ? "" : h("b.bad", " unsafe"));
  return h("ul", line(end, " as intended", 0),
    rest.slice(0, MOST_OUTCOMES).map((each, n) => line(each.state, h("small", ` ${wayText(spec, each.way)}`), n + 1)),
    rest.length > MOST_OUTCOMES ? h("li", `and ${rest.length - MOST_OUTCOMES} more`) : null);
}

// How well the decision restores safety, and the nominal run until it is restored.
function wayToSafety(app, state, chosen) {
  const { spec, model } = app;
  const quality = app.judge.restorations.quality(state, chosen);
  if (!quality) return h("p.bad", "It need not end in safety.");
  const [kind, lasting, steps] = quality;
  const better = spec.tiers.length > 1 ? "a severity more is kept" : "safety is restored";
  const words = kind === 2 ? `If effects are as intended, ${better} after ${counted(steps, "step")}, which take ${lasting}.` : `Whatever happens, ${better} after at most ${counted(steps, "step")}, which take at most ${lasting}.`;
  const list = [];
  let here = state;
  while (!isSafe(model, here) && list.length < 30) {
    const does = model.decide(here);
    if (does === null || !agree(spec, here, does)) break;
    const next = successor(spec, here, does);
    list.push(h("li", `${actionsText(spec, does)} → ${changeText(spec, here, next)}`));
    here = next;
  }
  return [h("p", words), h("ol", list)];
}
