// The judge of the page for tests: a JSON object with `spec` and `policy` on every line in, its judgement on every line out.
import { createInterface } from "node:readline";
import { fault, Judge, judgement } from "../../tumato_symbolic/report/html/judge.mjs";
import { decisionsFrom } from "../../tumato_symbolic/report/html/policy.mjs";
import { everyState, specFrom } from "../../tumato_symbolic/report/html/spec.mjs";
import { modelOf } from "../../tumato_symbolic/report/html/steps.mjs";

for await (const line of createInterface({ input: process.stdin })) {
  const data = JSON.parse(line);
  const spec = specFrom(data.spec);
  const model = modelOf(spec, decisionsFrom(spec, data.policy));
  const judge = new Judge(model);
  const faulty = [...everyState(spec)].filter((state) => fault(model, state, judge));
  console.log(JSON.stringify({ ...judgement(model), faulty }));
}
