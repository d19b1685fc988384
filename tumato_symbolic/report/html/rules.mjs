// The policy as a short list of rules: the first that matches decides.
import { conditions, h, redraw } from "./dom.mjs";
import { cubes } from "./policy.mjs";
import { inside, upTo } from "./spec.mjs";
import { actionsText, conditionsOf, counted } from "./words.mjs";

// Up to so many states it is found out exactly which rules decide some of them.
const MOST_LISTED = 20_000;

const matches = ([when], state) => when.every(([variable, ...values]) => values.includes(state[variable]));

export const firstMatch = (rules, state) => rules.list.findIndex((rule) => matches(rule, state));

export function rulesView(app) {
  const element = h("div");
  const { rules } = app.data;
  const update = () => {
    if (!rules.list) return redraw(element, h("p", `No short list of rules: ${rules}.`));
    const lit = firstMatch(rules, app.selected);
    const some = app.filter.some((each) => each) || app.executed !== null;
    const used = some ? deciding(app, rules) : null;
    const shown = rules.list.map((each, number) => [each, number]).filter(([[, actions], number]) => (!used || used.has(number)) && (app.executed === null || actions.includes(app.executed)));
    const head = some ? `${counted(shown.length, "rule")} of ${rules.list.length + rules.more} decide${shown.length === 1 ? "s" : ""} in these states.` : `${counted(rules.list.length + rules.more, "rule")}; the first that matches decides. The one for the chosen state is lit.`;
    return redraw(element, h("p.quiet", head),
      h("ol.rules", shown.map(([rule, number]) => item(app, rule, number, number === lit))),
      rules.more ? h("p.quiet", `and ${counted(rules.more, "more rule")}, which \`tumato-sym show --format rules\` lists`) : null,
      rules.left ? h("p.doubt", `They leave out ${counted(rules.left, "state")}: ${rules.limit}.`) : null);
  };
  return { element, update };
}

function item(app, [when, actions], number, lit) {
  const { spec } = app;
  const values = spec.names.map((_, n) => upTo(spec.sizes[n]));
  for (const [variable, ...some] of when) values[variable] = some;
  const words = conditionsOf(spec, values);
  return h("li", { value: number + 1, class: lit ? "lit" : null, "aria-current": lit ? "true" : null },
    h("b", actionsText(spec, actions)),
    words.length ? [" where ", conditions(words)] : number ? " everywhere else" : " everywhere");
}

// The numbers of the rules that decide a state under the filter; where there are too many states, that might.
function deciding(app, { list }) {
  const found = new Set();
  const { spec } = app;
  const values = spec.sizes.map((size, n) => (app.filter[n] ? [...app.filter[n]] : upTo(size)));
  if (values.reduce((all, some) => all * some.length, 1) > MOST_LISTED) {
    list.forEach(([when], number) => {
      if (when.every(([variable, ...some]) => some.some((value) => values[variable].includes(value)))) found.add(number);
    });
    return found;
  }
  for (const cube of cubes(spec, app.data.policy, app.filter)) {
    for (const state of inside(cube.values)) found.add(list.findIndex((rule) => matches(rule, state)));
  }
  return found;
}
