// The page of a specification without a policy.
import { readApp, start } from "./app.mjs";
import { listingView } from "./listing.mjs";
import { exampleOf, possibleIn, reasonsView, triedView } from "./reasons.mjs";

const app = readApp();
app.selected = exampleOf(app) ?? app.selected;
start(app, {
  check: triedView(app),
  explain: (state) => possibleIn(app, state),
  parts: [["reasons", "Why", reasonsView(app)], ["text", "Specification", listingView(app)]],
});
