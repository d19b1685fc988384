// What is done where, the decision first: in groups of states, or state by state.
import { chip, conditions, h, link, paged, redraw, table } from "./dom.mjs";
import { cubes, merged } from "./policy.mjs";
import { inside, upTo } from "./spec.mjs";
import { isSafe } from "./steps.mjs";
import { actionsText, shortText, conditionsOf, counted, grouped } from "./words.mjs";

// So many groups of states are listed; the rest is left out.
const MOST_GROUPS = 3_000;
// Up to so many states can be listed state by state.
const MOST_LINES = 10_000;
// So many rows a page of the table has.
const ROWS = 60;
// So many decisions are offered to choose from, those of most states first.
const MOST_DECISIONS = 12;
const UNDECIDED = "-";

const nameOf = (chosen) => (chosen ? chosen.join() : UNDECIDED);

// With starts, the valid states that the policy leaves out, where these can be listed.
function* undecidedUnder({ spec, model, filter, executed }) {
  if (!spec.starts.length || spec.total > MOST_LINES || executed !== null) return;
  for (const state of inside(spec.sizes.map((size, n) => (filter[n] ? [...filter[n]] : upTo(size))))) {
    if (model.assumed(state) && model.decide(state) === null) yield { values: state.map((value) => [value]), chosen: null, name: UNDECIDED, count: 1 };
  }
}

// Groups of states under the filter, those of the commonest decision first, and whether there are more.
export function groupsUnder(app) {
  const found = [];
  let more = false;
  for (const cube of cubes(app.spec, app.data.policy, app.filter, app.executed)) {
    if (found.length === MOST_GROUPS) {
      more = true;
      break;
    }
    found.push(cube);
  }
  const groups = merged([...found, ...undecidedUnder(app)]).map((each) => ({ ...each, name: nameOf(each.chosen) }));
  const totals = new Map();
  for (const { name, count } of groups) totals.set(name, (totals.get(name) ?? 0) + count);
  groups.sort((one, other) => totals.get(other.name) - totals.get(one.name) || one.name.localeCompare(other.name) || other.count - one.count);
  return { groups, totals, more, states: groups.reduce((all, each) => all + each.count, 0) };
}

export function tableView(app) {
  const element = h("div");
  let known = null;
  app.wanted = null;
  const update = () => {
    const name = `${app.executed};${app.filter.map((each) => (each ? [...each].sort() : "")).join(";")}`;
    if (known?.name !== name) known = { name, ...groupsUnder(app) };
    const groups = known.groups.filter((each) => app.wanted === null || each.name === app.wanted);
    const states = groups.reduce((all, each) => all + each.count, 0);
    const each = app.everyState && states <= MOST_LINES && !known.more;
    const go = (page) => { app.page = page; app.change(); };
    const list = each ? groups.flatMap(({ chosen, values }) => [...inside(values)].map((state) => ({ chosen, state }))) : groups;
    const [rows, turn] = paged(list, app.page, ROWS, go);
    redraw(element, summary(app, known), known.more ? h("p.quiet", `There are more groups than these, which hold ${grouped(known.states)} states; choose values above to see others.`) : null,
      states <= MOST_LINES && !known.more ? h("label", h("input", { type: "checkbox", key: "every", checked: app.everyState, onchange: (event) => { app.everyState = event.target.checked; app.page = 0; app.change(); } }), " every state on a line of its own") : null,
      each ? stateTable(app, rows) : groupTable(app, rows), turn);
  };
  return { element, update };
}

// The decisions under the filter with their numbers of states; one can be looked at alone.
function summary(app, { totals, more }) {
  const list = [...totals].sort((one, other) => other[1] - one[1]).slice(0, MOST_DECISIONS);
  return h("div.decisions", { role: "group", "aria-label": "decisions" }, list.map(([name, count]) => {
    const chosen = name === UNDECIDED ? null : name === "" ? [] : name.split(",").map(Number);
    return chip([h("b", shortText(app.spec, chosen)), ` ${grouped(count)}${more ? "+" : ""}`], app.wanted === name,
      () => { app.wanted = app.wanted === name ? null : name; app.page = 0; app.change(); }, { key: `d${name}`, title: actionsText(app.spec, chosen) });
  }), totals.size > list.length ? ` and ${counted(totals.size - list.length, "more decision")}` : null);
}

function groupTable(app, groups) {
  const { spec } = app;
  const row = (group, number) => h("tr", { class: holds(group, app.selected) ? "chosen" : null },
    h("td", link(app, actionsText(spec, group.chosen), nearest(group, app.selected), `g${number}`)),
    h("td.number", grouped(group.count)),
    h("td", where(app, group)));
  return table(["do", "states", "where"], groups.map(row));
}

// The conditions of a group that the filter does not say already.
function where(app, group) {
  const found = group.values.flatMap((some, n) => {
    const kept = app.filter[n] && some.length === app.filter[n].size ? upTo(app.spec.sizes[n]) : some;
    return conditionsOf({ names: [app.spec.names[n]], values: [app.spec.values[n]] }, [kept]);
  });
  return found.length ? conditions(found) : h("i", "everywhere");
}

const holds = (group, state) => group.values.every((some, n) => some.includes(state[n]));

// A state of a group, as near to another one as can be.
const nearest = (group, state) => group.values.map((some, n) => (some.includes(state[n]) ? state[n] : some[0]));

function stateTable(app, rows) {
  const { spec } = app;
  const row = ({ chosen, state }) => h("tr", { class: spec.key(state) === spec.key(app.selected) ? "chosen" : null },
    h("td", link(app, actionsText(spec, chosen), state, `s${spec.key(state)}`)),
    h("td", isSafe(app.model, state) ? "" : h("b.bad", "unsafe")),
    state.map((value, n) => h("td", spec.values[n][value])));
  return table(["do", "", ...spec.names], rows.map(row));
}
