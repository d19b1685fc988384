// The judge of the page for tests: a JSON object with `spec` and `policy` on every line in, its judgement on every line out.
import { createInterface } from "node:readline";
import { judgement } from "../../tumato_symbolic/report/html/judge.mjs";
import { decisionsFrom } from "../../tumato_symbolic/report/html/policy.mjs";
import { specFrom } from "../../tumato_symbolic/report/html/spec.mjs";
import { modelOf } from "../../tumato_symbolic/report/html/steps.mjs";

for await (const line of createInterface({ input: process.stdin })) {
  const data = JSON.parse(line);
  const spec = specFrom(data.spec);
  console.log(JSON.stringify(judgement(modelOf(spec, decisionsFrom(spec, data.policy)))));
}
