// Another policy that the reader opens, compared with this one: where it decides otherwise.
import { dice } from "./chance.mjs";
import { conditions, h, link, redraw } from "./dom.mjs";
import { decided, decisionsOfFile, differing, merged } from "./policy.mjs";
import { everyState } from "./spec.mjs";
import { actionsText, conditionsOf, counted, grouped } from "./words.mjs";

// Up to so many states, the decisions in all of them are compared.
const MOST_COMPARED = 400_000;
// Of more states, so many are drawn by chance.
const DRAWN_STATES = 20_000;
// So many groups of states with other decisions are looked for.
const MOST_CUBES = 3_000;
// So many changes are listed.
const MOST_CHANGES = 20;
// So many groups of states are listed of each change.
const MOST_WHERE = 4;

export function compareView(app) {
  const element = h("div");
  const said = h("div", { role: "status" });
  const input = h("input", { type: "file", accept: ".json,application/json", onchange: async () => {
    const [file] = input.files;
    if (!file) return;
    try {
      const other = decisionsOfFile(app.spec, await file.text());
      redraw(said, answer(app, file.name, differences(app, other)));
    } catch (error) {
      redraw(said, h("p.bad", `${file.name} cannot be compared: ${error.message}.`));
    }
  } });
  element.append(h("p", h("label", "Open another policy for this specification; it stays in this browser. ", input)), said);
  return { element };
}

// Cubes of states with the decision here (`chosen`) and there (`theirs`), out of how many states that one of them decides; not
// `complete` where there are more, and where states were `drawn` by chance.
function differences(app, other) {
  const { spec } = app;
  const diagram = app.data.policy;
  const at = app.given;
  const asCube = (state) => ({ values: state.map((value) => [value]), chosen: at(state), theirs: other.at(state), count: 1 });
  const differs = (state) => String(at(state) ?? "-") !== String(other.at(state) ?? "-");
  const { count, draw } = decided(spec, diagram, spec.names.map(() => null));
  let found = [];
  let complete = true;
  let drawn = 0;
  if (spec.total <= MOST_COMPARED) {
    for (const state of everyState(spec)) if (differs(state)) found.push(asCube(state));
  } else if (other.diagram && other.diagram.order.join() === diagram.order.join()) {
    for (const cube of differing(spec, diagram, other.diagram)) {
      complete = found.length < MOST_CUBES;
      if (!complete) break;
      found.push(cube);
    }
  } else {
    const chance = dice(3);
    for (; drawn < DRAWN_STATES; drawn++) {
      const state = draw(chance);
      if (differs(state)) found.push(asCube(state));
    }
  }
  const sum = (list) => list.reduce((all, each) => all + each.count, 0);
  const compared = drawn || count + BigInt(sum(found.filter((each) => each.chosen === null)));
  found = found.map((each) => ({ ...each, name: `${each.chosen ?? "-"}>${each.theirs ?? "-"}` }));
  return { groups: found.length > 50_000 ? found : merged(found), complete, drawn, compared, changed: sum(found) };
}

// The same words as those of `tumato-sym diff` (report/differing_decisions.py).
function answer(app, name, { groups, complete, drawn, compared, changed }) {
  const title = `${app.data.file} → ${name}: `;
  const of = counted(compared, drawn ? "drawn state" : "state");
  if (!changed) return h("p", { class: drawn ? "doubt" : "good" }, `${title}${of} decided, all alike.`);
  const changes = new Map();
  for (const each of groups) {
    const change = changes.get(each.name) ?? { ...each, cubes: [], count: 0 };
    change.cubes.push(each.values);
    change.count += each.count;
    changes.set(each.name, change);
  }
  const list = [...changes.values()].sort((one, other) => other.count - one.count);
  const left = list.length - MOST_CHANGES;
  return [h("p.doubt", `${title}${complete ? "" : "at least "}${grouped(changed)} of ${of} decided otherwise.`),
    list.slice(0, MOST_CHANGES).map((each) => [
      h("h3", link(app, `in ${counted(each.count, "state")}: ${setText(app.spec, each.chosen)} → ${setText(app.spec, each.theirs)}`, each.values.map(([value]) => value))),
      h("ul", each.cubes.slice(0, MOST_WHERE).map((values) => h("li", heldIn(app.spec, values))),
        each.cubes.length > MOST_WHERE ? h("li", `or ${grouped(each.cubes.length - MOST_WHERE)} more`) : null)]),
    left > 0 ? h("p.quiet", `${counted(left, "more kind")} of change ${left > 1 ? "are" : "is"} left out.`) : null];
}

const setText = (spec, chosen) => (chosen ? `{${chosen.length ? actionsText(spec, chosen) : ""}}` : "undecided");

function heldIn(spec, values) {
  const found = conditionsOf(spec, values);
  return found.length ? conditions(found) : "everywhere";
}
