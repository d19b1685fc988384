// The page at work: what it carries is read, its parts are made, and drawn again when something changes.
import { h } from "./dom.mjs";
import { decisionsFrom } from "./policy.mjs";
import { specFrom } from "./spec.mjs";
import { stateView } from "./state.mjs";
import { modelOf } from "./steps.mjs";
import { headView } from "./verdict.mjs";

export function readApp() {
  const data = JSON.parse(document.getElementById("data").textContent);
  const spec = specFrom(data.policy ? data.spec : { ...data.spec, starts: [] });
  const decisions = data.policy ? decisionsFrom(spec, data.policy) : { at: () => null };
  return { data, spec, given: decisions.at, model: modelOf(spec, decisions), filter: spec.names.map(() => null), page: 0, selected: spec.names.map(() => 0) };
}

// `parts` are [name, title, view] of the tabs; `explain` says what there is to say of a state.
export function start(app, { check, filter, parts, explain }) {
  const head = headView(app, check);
  const state = stateView(app, explain);
  const tabs = parts.map(([name, title, view]) => {
    const tab = h("button", { type: "button", role: "tab", id: `tab-${name}`, "aria-controls": `panel-${name}`, onclick: () => app.show(name), onkeydown: turn }, title);
    return { name, view, tab, panel: h("div", { role: "tabpanel", id: `panel-${name}`, "aria-labelledby": `tab-${name}` }, view.element) };
  });
  app.tab = parts[0][0];
  app.change = () => {
    filter?.update();
    state.update();
    for (const { name, view, tab, panel } of tabs) {
      const here = name === app.tab;
      tab.setAttribute("aria-selected", String(here));
      tab.tabIndex = here ? 0 : -1;
      panel.hidden = !here;
      if (here) view.update?.();
    }
  };
  app.select = (selected) => {
    app.selected = selected;
    app.change();
  };
  // Where the state is not at the side, it is shown, and there is a way back.
  app.visit = (selected) => {
    const from = state.element.contains(document.activeElement) ? app.from : scrollY;
    app.select(selected);
    if (!matchMedia("(max-width: 900px)").matches) return;
    app.from = from;
    state.element.scrollIntoView();
  };
  app.show = (name) => {
    app.tab = name;
    app.change();
  };
  function turn(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const at = tabs.findIndex((each) => each.name === app.tab);
    const next = tabs[(at + step + tabs.length) % tabs.length];
    app.show(next.name);
    next.tab.focus();
  }
  document.getElementById("page").replaceChildren(head, filter?.element ?? "",
    h("div.columns", h("div", h("div", { role: "tablist", "aria-label": "parts" }, tabs.map(({ tab }) => tab)), tabs.map(({ panel }) => panel)), state.element));
  setTimeout(app.change, 0);
}
