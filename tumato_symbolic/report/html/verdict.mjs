// The head of the page: what is proved, and by whom.
import { button, h } from "./dom.mjs";
import { counted } from "./words.mjs";

const MARKS = { proved: "✔", refuted: "✘", undecided: "?", unproved: "–" };

const RESTORED = {
  one_step: "in one step",
  bounded: "in several steps, within a bound whatever happens",
  fair: "in several steps, if nominal effects happen again and again",
};

// `check` is what the page found by itself.
export function headView(app, check) {
  const { verdict, no, file } = app.data;
  const words = (no ? {
    proved: `There is no policy: proved by ${verdict.by || "direct evaluation"}`,
    refuted: "The proof that there is no policy does not hold",
    undecided: "Whether there is a policy could not be proved",
    unproved: "There is no policy; that was not proved",
  } : {
    proved: `Proved by ${verdict.by}, for ${verdict.states}`,
    refuted: "Refuted: this policy is not right",
    undecided: "Not everything could be proved",
    unproved: "Nothing was proved",
  })[verdict.verdict];
  const kind = no || verdict.verdict === "refuted" ? "bad" : verdict.verdict === "proved" ? "good" : "doubt";
  return h("header",
    h("p.files", h("b", app.spec.file), ` · ${file}`),
    h(`h1.${kind}`, `${no ? "✘" : MARKS[verdict.verdict]} ${words}`),
    check,
    h("details", { open: verdict.verdict !== "proved" }, h("summary", "What that means"),
      no ? h("p", verdict.line) : h("ul.properties", verdict.properties.map((each) => property(app, each))), meaning(app.spec)));
}

function property(app, { name, verdict, by, claim, reason, refutation, state }) {
  return h("li", h("b", { class: verdict === "proved" ? "good" : "bad" }, `${MARKS[verdict]} ${name}`), ` ${verdict}${by ? " by " : ""}${by ?? ""}: ${claim}`, reason ? ` (${reason})` : "",
    refutation ? h("pre", refutation) : null, state ? button("look at that state", () => app.visit(state)) : null);
}

function meaning(spec) {
  return h("p.quiet", `${spec.states} states, ${counted(spec.names.length, "variable")}, ${counted(spec.actions.length, "action")}. `,
    `Effects count ${spec.ordering === "any" ? "in any order" : "only if they are the first"}. Safety is restored ${RESTORED[spec.restoration]}. `,
    spec.bound === null ? "Runs may have any length." : `Runs have at most ${counted(spec.bound, "step")}.`,
    spec.starts.length ? " There are starts: the policy decides them and all that can follow, and need not decide other states." : "");
}
