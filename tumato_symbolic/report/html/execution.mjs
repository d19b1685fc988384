// Executions on the page: by hand, to the goal, many by chance; and as a file (ITF).
import { dice, execution, randomMove } from "./chance.mjs";
import { button, h, redraw, save } from "./dom.mjs";
import { decided } from "./policy.mjs";
import { reached, residual } from "./runs.mjs";
import { agree, applied, isSafe, isValid, outcomes, successor } from "./steps.mjs";
import { upTo, valuesOf } from "./spec.mjs";
import { actionsText, changeText, counted, ENDS, grouped, otherwise, stateText, wayText } from "./words.mjs";

// So many executions are made when many are asked for.
const RUNS = 1_000;
// So many events each of them has at most.
const LONGEST = 1_000;
// So many steps are made at once to the goal.
const STEPS_TO_GOAL = 100;
// So many outcomes beside the nominal one are offered to choose from.
const MOST_OTHERS = 30;

export function executionView(app) {
  const element = h("div");
  const chance = dice(7);
  const settings = { faults: true, disturb: 0.05, from: "here" };
  let trace = { start: app.selected, events: [] };
  let results = {};
  const here = () => trace.events.at(-1)?.state ?? trace.start;
  const add = (event) => {
    trace = { ...trace, events: [...trace.events, event] };
    app.selected = event.state;
    app.change();
  };
  const begin = (state) => { trace = { start: state, events: [] }; app.change(); };
  const update = () => {
    if (app.spec.key(here()) !== app.spec.key(app.selected)) trace = { start: app.selected, events: [] };
    const asked = JSON.stringify([settings, app.selected, app.filter.map((some) => some && [...some])]);
    redraw(element,
      h("p.quiet", "From the chosen state: choose what happens. To choose another one begins anew."),
      history(app, trace), h("h3", "Next"), choices(app, here(), add, chance), disturbances(app, here(), add),
      h("p",
        button("run to the goal", () => goOn(app, here, add), { key: "run" }), " ",
        button("begin again", () => { app.selected = trace.start; begin(trace.start); }, { disabled: !trace.events.length, key: "again" }), " ",
        button("download this as ITF", () => save("trace.itf.json", itf(app, trace)), { key: "itf" })),
      h("h3", `${grouped(RUNS)} executions`), many(app, settings, update, () => { results = { asked, found: counts(app, settings) }; update(); }), results.asked === asked ? results.found : null);
  };
  return { element, update };
}

// Steps as intended until the goal of the first is met; at most as many as anybody would look at.
function goOn(app, here, add) {
  const { model, spec } = app;
  let goal = null;
  for (let n = 0; n < STEPS_TO_GOAL; n++) {
    const state = here();
    const chosen = model.decide(state);
    if (chosen === null || !agree(spec, state, chosen)) return;
    goal ??= residual(spec, state, chosen);
    const after = successor(spec, state, chosen);
    add({ state: after, chosen, way: null });
    if (reached(model, goal, after)) return;
  }
}

function history(app, trace) {
  const { spec, model } = app;
  const items = trace.events.map((event, n) => {
    const before = n ? trace.events[n - 1].state : trace.start;
    const changed = changeText(spec, before, event.state);
    const words = event.chosen === null ? `disturbance: ${changed}` : event.way ? `${actionsText(spec, event.chosen)}: ${wayText(spec, event.way)}` : `${actionsText(spec, event.chosen)} as intended: ${changed}`;
    return h("li", words, isSafe(model, event.state) ? "" : h("b.bad", " unsafe"));
  });
  return [h("p", "start: ", h("code", stateText(spec, trace.start))), h("ol.trace", items)];
}

function choices(app, state, add, chance) {
  const { spec, model } = app;
  const chosen = model.decide(state);
  if (chosen === null) return h("p", "Nothing is decided here.");
  if (!agree(spec, state, chosen)) return h("p", "The effects of the decision contradict each other.");
  const nominal = successor(spec, state, chosen);
  const rest = outcomes(spec, state, chosen).filter((each) => spec.key(each.state) !== spec.key(nominal));
  return [h("p", "The policy does ", h("b", actionsText(spec, chosen)), ". It goes"),
    h("p.choices",
      button(`as intended: ${changeText(spec, state, nominal)}`, () => add({ state: nominal, chosen, way: null }), { key: "nominal", class: "main" }),
      rest.slice(0, MOST_OTHERS).map((each, n) => button(`or instead: ${otherwise(spec, state, chosen, each)}`, () => add({ state: each.state, chosen, way: each.way }), { key: `way${n}` })),
      rest.length ? button("by chance", () => add({ ...randomMove(spec, state, chosen, chance), chosen }), { key: "chance" }) : null)];
}

function disturbances(app, state, add) {
  const { spec, model } = app;
  const changes = spec.sizes.flatMap((size, n) => upTo(size).filter((value) => value !== state[n]).map((value) => [n, value]));
  const possible = changes.filter((change) => isValid(model, applied(change, state)));
  const first = possible.find(([n]) => spec.environment.includes(n));
  const list = h("select", { "aria-label": "disturbance", key: "disturbance" }, possible.map((change) => h("option", { value: change.join(), selected: change === first }, `${spec.names[change[0]]} becomes ${spec.values[change[0]][change[1]]}`)));
  return h("p", "Or the world changes: ", list, " ",
    button("disturb", () => add({ state: applied(list.value.split(",").map(Number), state), chosen: null, way: null }), { disabled: !possible.length, key: "disturb" }));
}

// `changed` is called when something else is asked for, `go` when they are to be executed.
function many(app, settings, changed, go) {
  const option = (name, value, label) => h("label", h("input", { type: "checkbox", checked: value, key: name, onchange: (event) => { settings[name] = name === "disturb" ? (event.target.checked ? 0.05 : 0) : event.target.checked; changed(); } }), ` ${label} `);
  const from = h("select", { "aria-label": "where they start", key: "from", onchange: () => { settings.from = from.value; changed(); } },
    h("option", { value: "here", selected: settings.from === "here" }, "the chosen state"),
    h("option", { value: "filter", selected: settings.from === "filter" }, "the states chosen above, by chance"));
  return h("p", option("faults", settings.faults, "effects by chance"), option("disturb", settings.disturb > 0, "disturbances (1 in 20 steps)"), " from ", from, " ",
    button("execute", go, { key: "execute" }));
}

function counts(app, { faults, disturb, from }) {
  const { model, spec } = app;
  const chance = dice(1);
  const { count, draw } = decided(spec, app.data.policy, app.filter);
  if (from === "filter" && !count) return h("p", "None of these states is decided.");
  const ends = { goal: 0, loop: 0, bound: 0, undefined: 0 };
  const lengths = [];
  let unsafe = 0;
  for (let n = 0; n < RUNS; n++) {
    const start = from === "here" ? app.selected : draw(chance);
    const made = execution(model, start, { faults, disturb, most: LONGEST }, chance);
    ends[made.end] += 1;
    if (made.end === "goal") lengths.push(made.events.filter((each) => each.chosen !== null).length);
    let here = start;
    for (const event of made.events) {
      if (event.chosen !== null && isSafe(model, here) && !isSafe(model, event.state)) unsafe += 1;
      here = event.state;
    }
  }
  lengths.sort((a, b) => a - b);
  const middle = lengths.length ? `; steps to it: ${lengths[0]} to ${lengths.at(-1)}, half of them at most ${lengths[Math.floor((lengths.length - 1) / 2)]}` : "";
  const more = { goal: middle, bound: ` (${grouped(LONGEST)} events)` };
  return h("ul", Object.entries(ends).filter(([, number]) => number).map(([end, number]) =>
    h("li", { class: end === "goal" ? "good" : "doubt" }, `${grouped(number)} of ${grouped(RUNS)}: ${ENDS[end]}${more[end] ?? ""}`)),
  h("li", { class: unsafe ? "bad" : "good" }, `${unsafe ? counted(unsafe, "step") : "no step"} of the policy led from a safe state to an unsafe one${disturb ? " (disturbances are not counted)" : ""}`));
}

// The trace format of Apalache; the variables with colons are not of the specification.
function itf(app, trace) {
  const { spec } = app;
  const entry = (index, state, chosen, happened) => ({ "#meta": { index }, ...valuesOf(spec, state),
    "tumato::executed": { "#set": (chosen ?? []).map((number) => spec.actions[number].name) }, "tumato::happened": happened });
  const happened = (event, before) => (event.chosen === null ? "disturbance: " : `${actionsText(spec, event.chosen)}: `) + (event.way ? wayText(spec, event.way) : changeText(spec, before, event.state));
  const states = [entry(0, trace.start, null, "start")];
  trace.events.forEach((event, n) => states.push(entry(n + 1, event.state, event.chosen, happened(event, n ? trace.events[n - 1].state : trace.start))));
  return JSON.stringify({ "#meta": { format: "ITF", description: `an execution of a policy for ${spec.file}` }, vars: [...spec.names, "tumato::executed", "tumato::happened"], states }, null, 1);
}
