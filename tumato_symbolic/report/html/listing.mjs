// The specification as it was written.
import { h } from "./dom.mjs";

export function listingView(app) {
  const lines = app.spec.text.split("\n");
  const element = h("div.wide", h("ol.listing", lines.map((line, n) =>
    h("li", { id: `line-${n + 1}`, tabindex: -1 }, h("code", line || " ")))));
  return { element };
}
