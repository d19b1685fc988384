// Elements of the page (buttons, links, tables, pages of rows), and what is drawn again when something changes.

const present = (each) => each !== null && each !== undefined && each !== false;

function filled(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (present(value)) element.setAttribute(name === "key" ? "data-key" : name, value === true ? "" : value);
  }
  element.append(...children.flat(3).filter(present));
  return element;
}

// An element with attributes, if there are any (`on…` are listeners, true is present, `key` is what `redraw` knows it by), and children; `p.note` has a class.
export function h(name, ...children) {
  const [tag, kind] = name.split(".");
  const attributes = children[0]?.constructor === Object ? children.shift() : {};
  return filled(document.createElement(tag), kind ? { class: kind, ...attributes } : attributes, children);
}

export const svg = (tag, attributes, ...children) =>
  filled(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

// Put something new into an element. What had the focus has it again, if it has the same `data-key`.
export function redraw(element, ...children) {
  const key = element.contains(document.activeElement) ? document.activeElement.dataset.key : undefined;
  element.replaceChildren(...children.flat(3).filter(present));
  if (key !== undefined) [...element.querySelectorAll("[data-key]")].find((each) => each.dataset.key === key)?.focus();
}

export const button = (text, onclick, more) => h("button", { type: "button", onclick, ...more }, text);

// A button that looks like a link, and has another state looked at.
export const link = (app, text, state, key) => button(text, () => app.visit(state), { class: "link", key });

// A toggle; `pressed` is what it is now.
export const chip = (text, pressed, onclick, more) => button(text, onclick, { class: "chip", "aria-pressed": String(pressed), ...more });

export const conditions = (words) => words.map((each) => h("span.condition", each));

export const table = (heads, rows) => h("div.wide", h("table",
  h("thead", h("tr", heads.map((each) => h("th", { scope: "col", class: { states: "number", where: "most" }[each] }, each)))), h("tbody", rows)));

// A place in the specification, which the listing shows.
export function lineLink(app, rule) {
  return h("a", { href: `#line-${rule.line}`, class: "line", onclick: () => app.show("text") }, `line ${rule.line}`);
}

// A rule as it is written, with its place.
export function ruleText(app, rule) {
  if (rule.line === undefined) return h("q", rule.text);
  return h("span", h("code", rule.text), rule.with ? ` (${rule.with})` : "", " ", lineLink(app, rule));
}

// A page of a long list, with buttons for the others.
export function paged(list, at, most, go) {
  const pages = Math.ceil(list.length / most);
  const now = Math.min(at, Math.max(0, pages - 1));
  const turn = h("p.turn",
    button("‹ before", () => go(now - 1), { disabled: now === 0, key: "before" }),
    ` page ${now + 1} of ${pages} `,
    button("next ›", () => go(now + 1), { disabled: now >= pages - 1, key: "next" }));
  return [list.slice(now * most, (now + 1) * most), pages > 1 ? turn : null];
}

export function save(name, text) {
  const address = URL.createObjectURL(new Blob([text], { type: "application/json" }));
  h("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}
