// The page of a policy: which parts it has, and the state that it begins with.
import { readApp, start } from "./app.mjs";
import { checkView } from "./checking.mjs";
import { compareView } from "./compare.mjs";
import { decisionIn } from "./decision.mjs";
import { executionView } from "./execution.mjs";
import { filterView } from "./filter.mjs";
import { graphView } from "./graph.mjs";
import { listingView } from "./listing.mjs";
import { cubes } from "./policy.mjs";
import { rulesView } from "./rules.mjs";
import { everyState } from "./spec.mjs";
import { isSafe } from "./steps.mjs";
import { tableView } from "./table.mjs";

// So many states are looked at for one to begin with.
const MOST_TRIED = 5_000;

const app = readApp();
app.selected = firstState() ?? app.selected;
// A state to begin with: decided, and if one is soon found, safe.
function firstState() {
  const { spec, model } = app;
  let left = MOST_TRIED;
  for (const state of everyState(spec)) {
    if (left-- === 0) break;
    if (model.decide(state) !== null && isSafe(model, state)) return state;
  }
  const [cube] = cubes(spec, app.data.policy, app.filter);
  return cube?.values.map(([value]) => value);
}

start(app, {
  check: checkView(app),
  filter: filterView(app),
  explain: (state) => decisionIn(app, state),
  parts: [
    ["table", "What is done", tableView(app)],
    ["rules", "Rules", rulesView(app)],
    ["graph", "Graph", graphView(app)],
    ["execution", "Try it", executionView(app)],
    ["compare", "Compare", compareView(app)],
    ["text", "Specification", listingView(app)],
  ],
});
