// Why there is no policy: failing states, the lines to blame, and what could be changed.
import { button, conditions, h, lineLink, link } from "./dom.mjs";
import { goalsIn, others, section } from "./state.mjs";
import { allowedSets, isValid, successor } from "./steps.mjs";
import { stateOf } from "./tried.mjs";
import { actionsText, changeText, counted, grouped } from "./words.mjs";

const KINDS = {
  "no-allowed-set": "nothing may be done: no set of actions is allowed",
  "no-restoration": "safety is never surely restored",
  "no-plan": "no run of allowed steps reaches the goal",
  conflict: "each of these states has a plan, but no policy serves them all",
};

// So many groups of states, or sets of actions, are listed.
const MOST_SHOWN = 12;
// So many sets of actions are looked at for those that come near to being allowed.
const MOST_SETS = 2_000;

const firstFailure = ({ no }) => no.failures[0] ?? no.groups[0];

export function exampleOf(app) {
  const failure = firstFailure(app.data);
  return failure && stateOf(app, failure.example);
}

// What could be done in a state, without a policy.
export function possibleIn(app, state) {
  if (!isValid(app.model, state)) return null;
  const budget = { left: MOST_SETS };
  const found = [...allowedSets(app.model, state, Infinity, budget)];
  const all = budget.left < 0 ? grouped(MOST_SETS) : "all";
  const head = `Of ${all} sets of actions that may run together here ${found.length ? grouped(found.length) : "none"} ${found.length > 1 ? "are" : "is"} allowed.`;
  return [goalsIn(app, state), section("What could be done", [h("p", { class: found.length ? "quiet" : "bad" }, head),
    h("ul", found.slice(0, MOST_SHOWN).map((chosen) => {
      const after = successor(app.spec, state, chosen);
      return h("li", h("b", actionsText(app.spec, chosen)), " → ", link(app, changeText(app.spec, state, after), after));
    }))]), section("Each action alone", others(app, state, []))];
}

export function reasonsView(app) {
  const { no } = app.data;
  const unknown = no.verdict === "realizable" ? "There is a policy after all: this certificate proves nothing." : `Why there is none was not found out: ${no.limit}.`;
  const element = h("div", no.verdict !== "unrealizable" ? h("p.doubt", unknown) : [
    no.failing_states ? h("h2", `${counted(no.failing_states, "state")} ${no.failing_states === 1 ? "fails" : "fail"}.`) : null,
    no.failures.length ? no.failures.map((each, n) => reason(app, each, app.marks[n])) : no.groups.map((each) => failing(app, each)),
    no.repairs.length ? [h("h3", "What would help"), no.repairs.map(repair)] : null,
    part(no.realizable_part), no.left_out.map((each) => h("p.doubt", each))]);
  return { element };
}

const repair = (text) => (text.includes("\n") ? h("pre", text) : h("p", text));

function failing(app, { count, kind, cubes, omitted, example }) {
  const words = ([name, values]) => (values.length === 1 ? `${name} is ${values[0]}` : `${name} in {${values.join(", ")}}`);
  const more = cubes.length > MOST_SHOWN ? `and ${grouped(cubes.length - MOST_SHOWN)} more such groups` : omitted ? `and ${counted(omitted, "state")} more` : "";
  return h("section.reason", h("h3", `${counted(count, "state")}: ${KINDS[kind]}`),
    h("ul", cubes.slice(0, MOST_SHOWN).map((cube) => h("li", Object.keys(cube).length ? conditions(Object.entries(cube).map(words)) : "every valid state")), more ? h("li", more) : null),
    h("p", look(app, example, "look at one of them")));
}

const look = (app, named, words) => button(words, () => app.visit(stateOf(app, named)));

function reason(app, each, mark) {
  const element = failing(app, each);
  const parts = [
    each.states.length ? h("p", each.states.map((named, n) => [look(app, named, `state ${n + 1} of the conflict`), " "])) : null,
    each.summary ? h("p", each.summary) : null,
    each.core.length ? [h("p", "These lines together suffice for that; without any one of them they do not:", mark), h("ol", each.core.map((line) =>
      h("li", h("code", line.action ? `${line.action}: ${line.text}` : line.text), " ", line.line ? lineLink(app, line) : null, h("br"), h("small", line.role))))] : null,
    each.goals.length ? [h("p", "Its goals:"), h("ul", each.goals.map((goal) =>
      h("li", h("code", goal.text), " ", lineLink(app, goal), goal.never_true.length ? ` no effect ever makes this true: ${goal.never_true.join(", ")}` : "")))] : null,
    each.near.length ? [h("p", "What comes nearest:"), h("ul", each.near.map((story) => h("li", story)))] : null];
  element.append(...parts.flat().filter((one) => one));
  return element;
}

function part(found) {
  if (!found?.assumption) return null;
  return [h("h3", `There is a policy for ${counted(found.states, "state")}`),
    h("p", `under this assumption, which gives up ${counted(found.given_up, "state")}:`), h("pre", `assume: ${found.assumption}`)];
}
