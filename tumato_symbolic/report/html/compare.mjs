// What another policy decides otherwise.
import { dice } from "./chance.mjs";
import { conditions, h, link, redraw, table } from "./dom.mjs";
import { decided, decisionsOfFile, merged } from "./policy.mjs";
import { everyState, upTo } from "./spec.mjs";
import { actionsText, conditionsOf, counted, grouped } from "./words.mjs";

const MOST_COMPARED = 400_000;
const DRAWN_STATES = 20_000;
const MOST_CUBES = 3_000;
const MOST_ROWS = 200;

export function compareView(app) {
  const element = h("div");
  const said = h("div", { role: "status" });
  const input = h("input", { type: "file", accept: ".json,application/json", "aria-label": "another policy file", onchange: async () => {
    const [file] = input.files;
    if (!file) return;
    try {
      const other = decisionsOfFile(app.spec, await file.text());
      redraw(said, answer(app, file.name, differences(app, other)));
    } catch (error) {
      redraw(said, h("p.bad", `${file.name} cannot be compared: ${error.message}.`));
    }
  } });
  element.append(h("p", "Open another policy for this specification; it stays in this browser. ", input), said);
  return { element };
}

// Cubes of states with the decision here (`chosen`) and there (`theirs`); `complete` unless states were drawn.
function differences(app, other) {
  const { spec } = app;
  const diagram = app.data.policy;
  const at = app.given;
  const asCube = (state) => ({ values: state.map((value) => [value]), chosen: at(state), theirs: other.at(state), count: 1 });
  const differs = (state) => String(at(state) ?? "-") !== String(other.at(state) ?? "-");
  let found = [];
  let complete = true;
  if (spec.total <= MOST_COMPARED) {
    for (const state of everyState(spec)) if (differs(state)) found.push(asCube(state));
  } else if (other.diagram && other.diagram.order.join() === diagram.order.join()) {
    for (const cube of differing(spec, diagram, other.diagram)) {
      if (found.length === MOST_CUBES) {
        complete = false;
        break;
      }
      found.push(cube);
    }
  } else {
    const { draw } = decided(spec, diagram, spec.names.map(() => null));
    const chance = dice(3);
    complete = false;
    for (let n = 0; n < DRAWN_STATES; n++) {
      const state = draw(chance);
      if (differs(state)) found.push(asCube(state));
    }
  }
  found = found.map((each) => ({ ...each, name: `${each.chosen ?? "-"}>${each.theirs ?? "-"}` }));
  return { groups: found.length > 50_000 ? found : merged(found), complete, states: found.reduce((all, each) => all + each.count, 0) };
}

// The cubes in which two diagrams of one order decide otherwise: parts that are the same are passed over.
function* differing(spec, ours, theirs) {
  const levels = ours.order.length;
  const pairs = [[ours.defined, theirs.defined], ...ours.roots.map((root, n) => [root, theirs.roots[n]])];
  const level = (diagram, root) => (root > 1 ? diagram.nodes[root - 2][0] : levels);
  const known = new Map();
  const top = ([one, other]) => Math.min(level(ours, one), level(theirs, other));
  const child = (diagram, root, at, value) => (level(diagram, root) === at ? diagram.nodes[root - 2][1][value] : root);
  const down = ([one, other], at, value) => [child(ours, one, at, value), child(theirs, other, at, value)];
  const same = (pair) => {
    const at = top(pair);
    if (at === levels) return pair[0] === pair[1];
    const name = pair.join();
    if (!known.has(name)) known.set(name, upTo(spec.sizes[ours.order[at]]).every((value) => same(down(pair, at, value))));
    return known.get(name);
  };
  const pending = [[pairs, []]];
  while (pending.length) {
    const [here, fixed] = pending.pop();
    if (here[0].join() === "0,0" || here.every(same)) continue;
    const at = Math.min(...here.map(top));
    if (at === levels) {
      const values = spec.sizes.map((size) => upTo(size));
      for (const [n, value] of fixed) values[n] = [value];
      const decision = (side) => (here[0][side] ? here.slice(1).flatMap((pair, n) => (pair[side] ? [n] : [])) : null);
      yield { values, chosen: decision(0), theirs: decision(1), count: values.reduce((all, some) => all * some.length, 1) };
      continue;
    }
    const variable = ours.order[at];
    for (let value = spec.sizes[variable] - 1; value >= 0; value--) {
      pending.push([here.map((pair) => down(pair, at, value)), [...fixed, [variable, value]]]);
    }
  }
}

function answer(app, name, { groups, complete, states }) {
  const { spec } = app;
  const drawn = complete ? "" : ` among ${states ? "those" : "the states"} that were looked at`;
  if (!groups.length) return h("p", { class: complete ? "good" : "doubt" }, `${name} decides the same${complete ? " everywhere" : drawn}.`);
  groups.sort((one, other) => other.count - one.count);
  const first = groups.length > MOST_ROWS ? `; the first ${MOST_ROWS} of ${grouped(groups.length)} groups` : "";
  return [h("p.doubt", `${name} decides otherwise in ${counted(states, "state")}${drawn}${first}:`),
    table(["here", "there", "states", "where"], groups.slice(0, MOST_ROWS).map((each) => h("tr",
        h("td", link(app, actionsText(spec, each.chosen), each.values.map(([value]) => value))), h("td", actionsText(spec, each.theirs)),
        h("td.number", grouped(each.count)), h("td", conditions(conditionsOf(spec, each.values))))))];
}
