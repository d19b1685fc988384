// What the page finds when it looks at the decisions itself, a few at a time: all of them, or some drawn by chance.
import { dice } from "./chance.mjs";
import { button, h, link, redraw } from "./dom.mjs";
import { fault, Judge } from "./judge.mjs";
import { decided } from "./policy.mjs";
import { inSlices } from "./slices.mjs";
import { everyState } from "./spec.mjs";
import { faultText } from "./state.mjs";
import { agree, successor } from "./steps.mjs";
import { counted, grouped, stateText } from "./words.mjs";

// Up to so many states, the decisions in all of them are looked at.
const MOST_CHECKED = 400_000;
// Of more states, so many are drawn by chance at a time.
const DRAWN = 2_000;
// So many wrong decisions are listed.
const MOST_WRONG = 10;
// So many sets of actions are looked at for one decision, to find better ones.
const MOST_LOOKED_AT = 20_000;

export function checkView(app) {
  const element = h("div.check", { role: "status" });
  const whole = app.spec.total <= MOST_CHECKED;
  app.judge = new Judge(app.model, MOST_LOOKED_AT);
  app.found = { checked: 0, wrong: [], faults: 0, done: false };
  app.decisions = new Decisions(app.model);
  const { found } = app;
  const draw = () => redraw(element, told(app, whole),
    !whole && found.done ? button(`check ${grouped(DRAWN)} more`, () => go(chosenByChance(app, found.checked)), { key: "more" }) : null,
    found.wrong.length ? h("ul", found.wrong.map(([state, wrong]) => h("li", link(app, stateText(app.spec, state), state), " ", faultText(app, wrong)))) : null);
  const go = (states) => inSlices(checkAll(app, states), draw, () => app.change());
  go(whole ? everyState(app.spec) : chosenByChance(app, 1));
  draw();
  return element;
}

function* checkAll(app, states) {
  const { found, model } = app;
  found.done = false;
  for (const state of states) {
    const wrong = fault(model, state, app.judge);
    if (wrong) {
      found.faults += 1;
      if (found.wrong.length < MOST_WRONG) found.wrong.push([state, wrong]);
    }
    if (wrong || model.decide(state) !== null) found.checked += 1;
    app.decisions.note(state);
    yield;
  }
  found.done = true;
}

function* chosenByChance(app, seed) {
  const { draw, count } = decided(app.spec, app.data.policy, app.spec.names.map(() => null));
  const chance = dice(seed);
  for (let n = 0; count && n < DRAWN; n++) yield draw(chance);
}

function told(app, whole) {
  const { checked, faults, done } = app.found;
  const amount = counted(checked, "decision");
  const of = whole ? "" : `, drawn by chance from ${app.data.policy.decided},`;
  if (!done) return h("p", `This page is checking the decisions itself: ${amount} by now …`);
  if (faults) return h("p.bad", `✘ This page checked ${amount}${of} and their runs itself, of which ${grouped(faults)} are wrong:`);
  const open = app.judge.unfinished || !app.judge.restorations.whole ? " Whether a better set would do was not looked at to the end everywhere." : "";
  return h("p.good", `✔ This page checked ${amount}${of} and their runs itself, and found nothing wrong.${open}`);
}

// The decisions that were met, and how nominal effects lead from one to another.
class Decisions {
  constructor(model) {
    this.model = model;
    this.nodes = new Map();
    this.edges = new Map();
  }

  note(state) {
    const { model, nodes, edges } = this;
    const chosen = model.decide(state);
    if (chosen === null) return;
    const name = chosen.join();
    const node = nodes.get(name) ?? { chosen, count: 0, example: state };
    node.count += 1;
    nodes.set(name, node);
    if (!agree(model.spec, state, chosen)) return;
    const after = model.decide(successor(model.spec, state, chosen));
    if (after === null) return;
    const edge = `${name}>${after.join()}`;
    edges.set(edge, (edges.get(edge) ?? 0) + 1);
  }
}
