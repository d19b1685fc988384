// Which states are looked at: some values of some variables.
import { button, chip, h } from "./dom.mjs";
import { decided } from "./policy.mjs";
import { grouped } from "./words.mjs";

export function filterView(app) {
  const { spec } = app;
  app.executed = null;
  const chips = spec.names.map((name, n) => spec.values[n].map((value, number) =>
    chip(value, false, () => toggle(app, n, number), { title: `${name} is ${value}` })));
  const rows = spec.names.map((name, n) => {
    const own = spec.environment.includes(n) ? h("small", { title: "no action writes it" }, " environment") : null;
    return h("div.variable", { role: "group", "aria-label": name }, h("span.name", name, own), chips[n]);
  });
  const count = h("p", { role: "status" });
  const search = h("input", { type: "search", placeholder: "find a variable or a value", "aria-label": "find a variable or a value",
    oninput: () => rows.forEach((row, n) => { row.hidden = !`${spec.names[n]} ${spec.values[n].join(" ")}`.toLowerCase().includes(search.value.toLowerCase()); }) });
  const executed = h("select", { "aria-label": "where this action is executed", onchange: () => {
    app.executed = executed.value === "" ? null : Number(executed.value);
    looked(app);
  } }, h("option", { value: "" }, "whatever is done"), spec.actions.map((action, number) => h("option", { value: number }, `where ${action.name} is done`)));
  const anew = () => {
    app.filter = spec.names.map(() => null);
    app.executed = null;
    executed.value = "";
  };
  const clear = button("clear", () => {
    anew();
    looked(app);
  });
  const update = () => {
    chips.forEach((row, n) => row.forEach((each, value) => each.setAttribute("aria-pressed", String(app.filter[n]?.has(value) ?? false))));
    const some = app.filter.some((each) => each);
    clear.disabled = !some && app.executed === null;
    if (!app.data.policy) return;
    const found = decided(spec, app.data.policy, app.filter).count;
    const part = some ? `${grouped(found)} of` : "all";
    count.textContent = `${part} ${app.data.policy.decided}${spec.starts.length ? " decided" : ""} states`;
  };
  const example = spec.environment[0] ?? 0;
  const hint = h("p.quiet", "Press values to ask what is done where they hold, for instance ",
    button(`${spec.names[example]} is ${spec.values[example].at(-1)}`, () => {
      anew();
      toggle(app, example, spec.sizes[example] - 1);
    }, { class: "link" }), ".");
  const element = h("section.filter", { "aria-label": "which states" },
    h("div", { class: "line-of" }, h("h2", "In which states?"), count, executed, clear, spec.names.length > 12 ? search : null), hint,
    h("div.variables", rows));
  return { element, update };
}

function toggle(app, n, value) {
  const some = new Set(app.filter[n] ?? []);
  if (!some.delete(value)) some.add(value);
  app.filter[n] = some.size && some.size < app.spec.sizes[n] ? some : null;
  looked(app);
}

// Other states are looked at. The chosen one is among them, and is again the one before when the filter no longer excludes it.
function looked(app) {
  if (app.selected !== app.narrowed) app.own = app.selected;
  app.selected = app.narrowed = app.own.map((value, n) => (app.filter[n] && !app.filter[n].has(value) ? Math.min(...app.filter[n]) : value));
  app.wanted = null;
  app.page = 0;
  app.change();
}
