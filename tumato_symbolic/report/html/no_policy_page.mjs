// The page of a specification without a policy: which parts it has.
import { readApp, start } from "./app.mjs";
import { listingView } from "./listing.mjs";
import { h } from "./dom.mjs";
import { exampleOf, possibleIn, reasonsView } from "./reasons.mjs";
import { triedView } from "./tried.mjs";

const app = readApp();
app.selected = exampleOf(app) ?? app.selected;
app.marks = app.data.no.failures.map(() => h("small.good"));
start(app, {
  check: triedView(app),
  explain: (state) => possibleIn(app, state),
  parts: [["reasons", "Why", reasonsView(app)], ["text", "Specification", listingView(app)]],
});
