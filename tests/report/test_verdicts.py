"""Verdicts that no small example reaches."""

from msgspec.structs import replace

from tests.cli.inputs import CONFLICT
from tests.repo.documents import ROOT
from tumato_symbolic import Realizable, Undecided, Unrealizable, parse, synthesize, verify
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.report.findings import as_github
from tumato_symbolic.report.synthesized import Synthesized, as_json, as_text, findings
from tumato_symbolic.report.unrealizable import proof_line
from tumato_symbolic.verify import verify_unrealizable
from tumato_symbolic.verify.result import ProverName

COIN = (ROOT / "examples" / "coin.tum").read_text(encoding="utf-8")
SPEC = parse(CONFLICT)
OUTCOME = synthesize(SPEC)
assert isinstance(OUTCOME, Unrealizable)
GIVEN_UP = Synthesized(
    Source("big.tum", CONFLICT),
    SPEC,
    Undecided("too many goals", OUTCOME.statistics),
    None,
    (),
    "p.json",
    False,
    1.0,
    0.0,
)


def test_undecided_names_the_limit() -> None:
    """No verdict comes without the limit that was met, in every format."""
    text = as_text(GIVEN_UP, colour=False)
    assert "big.tum: undecided: too many goals." in text
    assert "No policy was written." in text
    report = as_json(GIVEN_UP)
    assert (report["verdict"], report["limit"], report["policy"]) == ("undecided", "too many goals", None)
    assert as_github(findings(GIVEN_UP)) == "::error file=big.tum,title=undecided::undecided: too many goals"


def test_github_names_the_prover() -> None:
    """The notice says who proved the policy, not who mostly does."""
    spec = parse(COIN)
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    named: dict[ProverName, str] = {"z3": "proved by Z3", "walk": "proved by the walk"}
    for prover, told in named.items():
        proof = verify(outcome.policy, spec, prover=prover)
        done = replace(GIVEN_UP, spec=spec, outcome=outcome, proof=proof, written=True)
        assert as_github(findings(done)) == f"::notice file=big.tum::realizable, {told}"


def test_what_others_change_is_named_where_there_is_no_plan() -> None:
    """A goal that depends on people fails where they are in the way, and the report says that no action moves them."""
    text = """BEGIN STATE VECTOR state A can be no, yes state Door can be free, blocked END STATE VECTOR
    BEGIN ACTIONS action go preconditions: Door is free nominal effects: A is yes END ACTIONS
    BEGIN GOALS goal type: priority goal: A is yes END GOALS"""
    told = "No action changes Door, and no plan waits for others: ask for less where a goal does."
    push = " action push preconditions: A is yes nominal effects: Door is free END ACTIONS"
    for variant, expected in ((text, True), (text.replace(" END ACTIONS", push), False)):
        spec = parse(variant)
        outcome = synthesize(spec)
        assert isinstance(outcome, Unrealizable)
        report = as_text(replace(GIVEN_UP, spec=spec, outcome=outcome), colour=False)
        assert (told in report) == expected


SAFETY_ONLY = """BEGIN STATE VECTOR state A can be on, off state Lamp can be lit, dark END STATE VECTOR
BEGIN ACTIONS action dim preconditions: Lamp is lit nominal effects: Lamp is dark END ACTIONS
BEGIN STATE RULES severity: 1 rule: Lamp is dark severity: 2 rule: A is off END STATE RULES
BEGIN GOALS goal type: priority goal: true END GOALS BEGIN CONFIG restoration: bounded END CONFIG"""


def test_less_than_safety_is_not_asked_for() -> None:
    """Where only safety is asked for, the goal is not blamed; where a goal asks for more, it is."""
    for goal, bound, told in (
        ("true", "", "Only safety is asked for there, and no run of allowed sets, however long, restores it."),
        ("true", "max_plan_length: 5", "or exclude what cannot happen with `assume:`, or raise max_plan_length."),
        ("Lamp is dark", "", "or ask for less (`when … then goal: …`)."),
    ):
        spec = parse(SAFETY_ONLY.replace("goal: true", f"goal: {goal}").replace("END CONFIG", f"{bound} END CONFIG"))
        outcome = synthesize(spec)
        assert isinstance(outcome, Unrealizable)
        report = as_text(replace(GIVEN_UP, spec=spec, outcome=outcome), colour=False)
        failed = report[report.index("error[TUM402]") :]
        assert told in failed
        assert ("ask for less" in failed) == (goal != "true")


def test_the_proof_speaks_of_starts_where_there_are_some() -> None:
    """A certificate that no part has a policy, without starts and with them."""
    plain = SAFETY_ONLY.replace("restoration: bounded", "")
    for text, told in (
        (plain, "there is no policy that decides every valid state (no-part)"),
        (plain + " BEGIN START start: Lamp is lit END START", "no policy from the starts that never leaves"),
    ):
        spec = parse(text)
        outcome = synthesize(spec)
        assert isinstance(outcome, Unrealizable)
        assert outcome.certificate is not None
        assert told in proof_line(spec, verify_unrealizable(outcome.certificate, spec))


def test_a_policy_too_large_to_draw_comes_with_the_command_that_shows_it() -> None:
    """That the picture is left out is said, and how to see it; also where the policy is in no file."""
    for example, drawn in (("coin", True), ("forklift", False)):
        spec = parse((ROOT / "examples" / f"{example}.tum").read_text(encoding="utf-8"))
        done = replace(GIVEN_UP, spec=spec, outcome=synthesize(spec), written=True, output="p.json")
        text = as_text(done, colour=False)
        show = f"left out here. To see them:\n  tumato-sym show p.json {GIVEN_UP.source.name}"
        assert ("What it does" in text, show in text) == (True, not drawn)
        apart = as_text(replace(done, output="-"), colour=False)
        assert ("tumato-sym show POLICY" in apart) == (not drawn)


def test_actions_that_no_state_needs_are_named() -> None:
    """The policy tosses one coin only; of many such actions the first ones are listed."""
    for example, line in (
        ("coin", "  never executed: toss_for_tails"),
        ("grid3", "left_from_top_right, up_from_middle_left and 11 more"),
    ):
        spec = parse((ROOT / "examples" / f"{example}.tum").read_text(encoding="utf-8"))
        outcome = synthesize(spec)
        done = replace(GIVEN_UP, spec=spec, outcome=outcome)
        assert line in as_text(done, colour=False)
        names = as_json(done)["never_executed"]
        assert isinstance(names, tuple)
        assert len(names) == (1 if example == "coin" else 16)


def test_a_long_conflict_is_cut() -> None:
    """A conflict of many states lists the first ones and says how many are left."""
    assert isinstance(OUTCOME, Unrealizable)
    (failure,) = OUTCOME.failures
    many = replace(failure, count=20, states=failure.states * 10)
    text = as_text(replace(GIVEN_UP, outcome=replace(OUTCOME, failures=(many,))), colour=False)
    assert "… and 12 more" in text


def test_colour_only_marks_the_verdict() -> None:
    """Colours add no text."""
    plain, coloured = as_text(GIVEN_UP, colour=False), as_text(GIVEN_UP, colour=True)
    assert coloured.replace("\x1b[33;1m", "").replace("\x1b[0m", "") == plain


def test_pure_python_is_said_once() -> None:
    """Who waits for diagrams in pure Python learns why; with CUDD nothing is said."""
    assert isinstance(OUTCOME, Unrealizable)
    slow = replace(OUTCOME, statistics=replace(OUTCOME.statistics, backend="autoref"))
    for outcome in (slow, Undecided("too many goals", slow.statistics)):
        assert as_text(replace(GIVEN_UP, outcome=outcome), colour=False).count("pure Python") == 1
    fast = replace(OUTCOME, statistics=replace(OUTCOME.statistics, backend="cudd"))
    assert "pure Python" not in as_text(replace(GIVEN_UP, outcome=fast), colour=False)
