// What the page finds itself where there is no policy: whether states fail as is said, and whether the lines to blame suffice.
import { h, link, redraw } from "./dom.mjs";
import { Alone, coreHolds, lostStates, TOO_MUCH } from "./failing.mjs";
import { inSlices } from "./slices.mjs";
import { inside, specFrom } from "./spec.mjs";
import { isValid } from "./steps.mjs";
import { counted, grouped, stateText } from "./words.mjs";

// So many states are tried of each reason or conflict.
const MOST_STATES = 1_000;
// So many sets of actions are tried for each of them.
const MOST_TRIED = 10_000;
// So many sets of actions are tried to find the states that are lost whatever a policy does.
const MOST_IN_PART = 1_000_000;
// After so many states of which nothing was found out, no more are tried.
const MOST_UNKNOWN = 20;
// So many states are listed that do not fail as is said.
const MOST_WRONG = 10;

export const stateOf = (app, named) => app.spec.names.map((name, n) => app.spec.values[n].indexOf(String(named[name])));

export function triedView(app) {
  const { no } = app.data;
  const element = h("div.check", { role: "status" });
  const found = { failing: 0, unknown: 0, wrong: [], cores: 0, coresOpen: 0, coresWrong: 0, done: false };
  const draw = () => redraw(element, told(app, found));
  draw();
  if (no.groups.length) inSlices(checks(app, found), draw, () => {});
  return element;
}

function* checks(app, found) {
  const { no } = app.data;
  const alone = new Alone(app.model, { left: 0 });
  const whole = specFrom(app.data.spec);
  const lost = whole.starts.length ? yield* attempt(alone, () => lostStates(whole, MOST_IN_PART)) : null;
  const exact = !whole.starts.length;
  for (const group of no.groups) {
    const states = statesOf(app, group);
    if (group.kind === "conflict") {
      const served = group.omitted || states.length > MOST_STATES ? null : yield* attempt(alone, () => alone.together(states));
      note(found, states, served === null ? null : !served, exact && !app.spec.stepwise);
      continue;
    }
    for (const state of states.slice(0, MOST_STATES)) {
      if (found.unknown > MOST_UNKNOWN) break;
      const kind = exact ? yield* attempt(alone, () => alone.kind(state), undefined) : undefined;
      note(found, [state], exact ? kind && kind === group.kind : lost?.has(app.spec.key(state)), exact ? kind !== undefined : lost);
      yield;
    }
  }
  for (const [n, failure] of no.failures.entries()) {
    const suffice = yield* attempt(alone, () => reasonHolds(app, failure));
    found[suffice === null ? "coresOpen" : suffice ? "cores" : "coresWrong"] += 1;
    app.marks[n].textContent = suffice === null ? "" : suffice ? " ✔ checked by this page" : " ✘ not what this page finds";
    yield;
  }
  found.done = true;
}

// The states of a group that are listed.
function statesOf(app, { cubes }) {
  const { spec, model } = app;
  const values = (cube) => spec.names.map((name, n) => (cube[name] ?? spec.values[n]).map((value) => spec.values[n].indexOf(String(value))));
  const found = [];
  for (const cube of cubes) {
    for (const state of inside(values(cube))) {
      if (isValid(model, state)) found.push(state);
      if (found.length > MOST_STATES) return found;
    }
  }
  return found;
}

// What some work gives; null, or what is said, where it is too much.
function* attempt(alone, work, otherwise = null) {
  alone.budget.left = MOST_TRIED;
  try {
    return yield* work();
  } catch (error) {
    if (error !== TOO_MUCH) throw error;
    return otherwise;
  }
}

// Take down whether states fail as is said; that they do not says something only where all was looked at.
function note(found, states, fails, whole) {
  if (fails) found.failing += states.length;
  else if (whole) found.wrong.push(...states);
  else found.unknown += states.length;
}

// Whether the lines of a core suffice, and none can be left out; null where it is not looked at.
function* reasonHolds(app, { kind, elements, example, states, later }) {
  const { spec, data } = app;
  const conflict = kind === "conflict";
  if (later || spec.tiers.length > 1 || (conflict && (spec.stepwise || data.spec.starts.length))) return null;
  const told = (conflict ? states : [example]).map((each) => stateOf(app, each));
  return yield* coreHolds(spec, data.alternatives, { kind, elements, states: told }, MOST_TRIED);
}

function told(app, found) {
  const { no } = app.data;
  const { failing, wrong, done, cores, coresOpen, coresWrong } = found;
  if (!no.groups.length) return h("p.quiet", "This page does not check itself that there is no policy.");
  const all = no.groups.reduce((sum, each) => sum + each.count, 0);
  if (wrong.length) {
    return [h("p.bad", `✘ This page finds that ${counted(wrong.length, "state")} ${wrong.length > 1 ? "do" : "does"} not fail as is said${done ? "" : ", by now"}:`),
      h("ul", wrong.slice(0, MOST_WRONG).map((state) => h("li", link(app, stateText(app.spec, state), state))))];
  }
  if (!done) return h("p", `This page is trying itself whether these states fail: ${grouped(failing)} of ${counted(all, "state")} by now …`);
  const of = `${grouped(no.failures.length)} reasons`;
  const some = coresOpen ? `, of ${grouped(cores)} of ${of}` : "";
  const open = [failing && failing < all ? `the other ${counted(all - failing, "state")}` : null,
    no.groups[0].kind === "conflict" ? null : "whether more states fail",
    coresOpen ? `the lines of ${grouped(coresOpen)} of ${of}` : null, no.repairs.length ? "what would help" : null,
    no.realizable_part?.states ? "for which states there is a policy" : null].filter((each) => each);
  return [failing ? h("p.good", `✔ This page tried it itself: ${failureText(no, failing, all)}.`) : h("p.doubt", "It is too much for this page to try itself whether these states fail."),
    coresWrong ? h("p.bad", `✘ It finds that the lines of ${grouped(coresWrong)} of ${of} below are not those to blame.`) : null,
    cores ? h("p.good", `✔ It tried the lines named below too: they suffice for that, and none of them can be left out${some}.`) : null,
    open.length ? h("p.quiet", `Not checked by this page: ${open.join("; ")}.`) : null];
}

function failureText({ groups }, failing, all) {
  if (groups[0].kind === "conflict") return `no choice of actions lets the ${counted(all, "state")} of the conflict all reach their goals, so there is no policy`;
  if (failing < all) return `${grouped(failing)} of ${grouped(all)} states said to fail do fail, which is enough for there being no policy`;
  return all === 1 ? "the state said to fail does fail, so there is no policy" : `all ${grouped(all)} states said to fail do fail, so there is no policy`;
}
