// The page of a policy.
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
import { tableView } from "./table.mjs";

const app = readApp();
const [first] = cubes(app.spec, app.data.policy, app.filter);
if (first) app.selected = first.values.map(([value]) => value);
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
