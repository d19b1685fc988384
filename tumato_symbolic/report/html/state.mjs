// One state: what holds in it, which goals are active, and why other things are not done in it.
import { button, h, lineLink, redraw, ruleText } from "./dom.mjs";
import { smaller } from "./restoring.mjs";
import { run, writtenGoals } from "./runs.mjs";
import { duration, isSafe, objection } from "./steps.mjs";
import { counted, ENDS, objectionText } from "./words.mjs";

// The values of the state, which can be changed, and what `explain(state)` says of it.
export function stateView(app, explain) {
  const { spec } = app;
  const selects = spec.names.map((name, n) => h("select", { "aria-label": name, onchange: (event) => {
    app.select(app.selected.map((value, at) => (at === n ? Number(event.target.value) : value)));
  } }, spec.values[n].map((value, number) => h("option", { value: number }, value))));
  const body = h("div");
  let shown = null;
  const element = h("section.state", { "aria-label": "one state" },
    button("↑ back", () => scrollTo(0, app.from ?? 0), { class: "back" }), h("h2", "One state"),
    h("div.selects", spec.names.map((name, n) => h("label", h("span", name), selects[n]))), body);
  const update = () => {
    selects.forEach((each, n) => {
      each.value = app.selected[n];
      each.parentElement.classList.toggle("narrowed", Boolean(app.filter[n]));
    });
    redraw(body, standing(app, app.selected), explain(app.selected));
    if (shown !== app.selected) element.scrollTop = 0;
    shown = app.selected;
  };
  return { element, update };
}

// Whether a state is valid and safe, and the rules that it breaks.
function standing(app, state) {
  const { model, spec } = app;
  const excluded = spec.assumptions.filter((rule) => !rule.holds(state, []));
  const broken = spec.state_rules.filter((rule) => !rule.holds(state, []));
  const word = excluded.length ? "not valid" : broken.length ? "unsafe" : "safe";
  return [h("p", h("b", { class: word === "safe" ? "good" : "bad" }, word), spec.starts.length && model.isStart(state) ? ", a start" : ""),
    [...excluded, ...broken].map((rule) => h("p", rule.severity ? "broken: " : "excluded by the assumption: ", ruleText(app, rule)))];
}

export const section = (title, content) => h("details", { open: true }, h("summary", title), content);

export function goalsIn(app, state) {
  const active = writtenGoals(app.spec, state);
  return section("Goals", active.length ? h("ul", active.map((goal) => h("li", ruleText(app, goal)))) : h("p", "No goal is active: any allowed step will do."));
}

// What is wrong with the decision in a state, as the judge says it.
export function faultText(app, [property, detail]) {
  const { spec } = app;
  if (property === "total") return "is not decided";
  if (property === "invalid") return "is decided, although it is not valid";
  if (property === "restoring") return "is not surely restored to safety";
  if (property === "goals") return `misses its goal: ${ENDS[detail.end]}`;
  if (property === "minimal") return `would be restored better by ${detail.map((number) => spec.actions[number].name).join(", ") || "doing nothing"}`;
  return ["has a decision that is not allowed: ", why(app, detail)];
}

function why(app, found) {
  const [words, rule] = objectionText(app.spec, found);
  return [words, " ", rule ? ruleText(app, rule) : ""];
}

// For each action why it is not done instead, or as well; those that lack the same precondition together.
export function others(app, state, chosen) {
  const { spec, model } = app;
  const rows = [];
  if (chosen.length) rows.push(["nothing", compared(app, state, chosen, [])]);
  const lacking = new Map();
  spec.actions.forEach((action, number) => {
    if (chosen.includes(number)) return;
    const found = objection(model, state, [number]);
    if (found?.kind === "precondition" && found.rule) {
      const { text } = found.rule;
      lacking.set(text, [...(lacking.get(text) ?? []), [action.name, found.rule]]);
      return;
    }
    rows.push([action.name, compared(app, state, chosen, [number])]);
    if (chosen.length) rows.push([`${action.name} as well`, compared(app, state, chosen, [...chosen, number].sort((a, b) => a - b))]);
  });
  return h("ul.others", rows.map(([name, words]) => h("li", h("b", name), ": ", words)),
    [...lacking].map(([text, all]) => h("li", all.map(([name, rule], n) => [n ? ", " : "", h("b", name), " (", lineLink(app, rule), ")"]), all.length > 1 ? " need " : " needs ", h("code", text))));
}

// Why another set is not chosen (docs/semantics.md, section 6).
function compared(app, state, chosen, other) {
  const { spec, model, judge } = app;
  const found = objection(model, state, other);
  if (found) return why(app, found);
  if (!judge) return "allowed";
  const made = run(model, state, other);
  if (made.end !== "goal") return `allowed, but ${ENDS[made.end]}`;
  if (!isSafe(model, state)) {
    const [ours, theirs] = [chosen, other].map((each) => (spec.stepwise ? judge.restorations.quality(state, each) : [0, duration(spec, each), 1]));
    if (!theirs) return "allowed, but need not lead to safety";
    if (ours && smaller(ours, theirs)) {
      if (ours[0] < theirs[0]) return "restores safety less surely, or in more steps";
      return ours[1] < theirs[1] ? `takes ${theirs[1]} rather than ${ours[1]}` : `needs ${counted(theirs[2], "step")} to safety rather than ${ours[2]}`;
    }
    if (!ours || smaller(theirs, ours)) return "restores this state better, but would keep another from its goal";
  }
  const steps = run(model, state, chosen).decisions.length;
  if (steps < made.decisions.length) return `needs ${counted(made.decisions.length, "step")} to the goal rather than ${steps}`;
  if (steps > made.decisions.length) return "is shorter, but leads through the goals of others, or would keep another state from its goal";
  if (chosen.length < other.length) return "does more than is needed";
  const first = chosen.findIndex((action, n) => action !== other[n]);
  return chosen.length === other.length && chosen[first] < other[first] ? "is as good, and declared later" : "would do as well";
}
