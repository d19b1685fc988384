"""Synthesis on specifications made by hand: one for each way in which a policy comes about, or does not."""

from __future__ import annotations

from importlib import import_module
from itertools import combinations

import pytest
from msgspec.structs import replace

from tests.semantics.build import Build, constraint, priority, when
from tumato_symbolic.diagnostics import Code, UserError
from tumato_symbolic.game.fixpoints import attractor
from tumato_symbolic.game.problem import build_problem
from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.policy import Policy, Table, as_table, dumps
from tumato_symbolic.semantics import ActionSet, State, judge
from tumato_symbolic.spec import FALSE, And, Is, Not, Or, Spec
from tumato_symbolic.symbolic import Backend, available_backend
from tumato_symbolic.synthesis import Realizable, SynthesisResult, Undecided, Unrealizable, synthesize

pipeline = import_module("tumato_symbolic.synthesis.synthesize")
completing = import_module("tumato_symbolic.synthesis.completing")


def rows(outcome: SynthesisResult) -> dict[State, ActionSet]:
    """The decisions of a realizable outcome."""
    assert isinstance(outcome, Realizable)
    assert isinstance(outcome.policy.decisions, Table)
    return dict(outcome.policy.decisions.rows)


def line(bound: int | None = None) -> tuple[Build, Spec]:
    """Four places in a row, one step to the right or left at a time; the goal is the last one."""
    build = Build({"x": "abcd"})
    for here, there in ("ab", "bc", "cd", "dc", "cb", "ba"):
        build.action(f"x={there}", when=[build.atom(f"x={here}")])
    return build, build.spec(priority(build.goal(build.atom("x=d"))), bound=bound)


def test_huge_durations_are_exact() -> None:
    """Durations beyond machine integers are compared as they are written."""
    build = Build({"x": "ab"})
    build.action("x=b", duration=10**30 + 1)
    build.action("x=b", duration=10**30)
    spec = build.spec(state_rules=[build.atom("x=b")])
    assert rows(synthesize(spec))[build.state("a")] == {1}


def interacting() -> Spec:
    """Load both, then deliver: a half-loaded robot would deliver at once, but then nobody ever loads both."""
    build = Build({"p": "ny", "q": "ny"})
    for name in "pq":
        build.action(f"{name}=y", when=[build.atom(f"{name}=n")])
        build.action(f"{name}=n", when=[build.atom(f"{name}=y")])
    p, q = build.atom("p=y"), build.atom("q=y")
    empty = And((Not(p), Not(q)))
    goals = priority(
        when(empty, build.goal(And((p, q)))),
        when(p, build.goal(Not(p))),
        when(q, build.goal(Not(q))),
    )
    return build.spec(goals)


def exclusive(spec: Spec) -> Spec:
    """The same with at most one action at a time."""
    single = tuple(replace(action, resources=frozenset((0,))) for action in spec.actions)
    return replace(spec, actions=single, resources=("ARM",))


def test_goals_that_interact_are_solved_and_little_is_changed() -> None:
    """One half-loaded state has to load before it delivers; the other keeps its own shortest run."""
    spec = interacting()
    spec = exclusive(spec)
    outcome = synthesize(spec)
    judgement = judge(spec, rows(outcome), "any")
    assert judgement.sound_and_complete
    assert outcome.statistics is not None
    assert judgement.longest_run == outcome.statistics.longest_run
    assert outcome.statistics.changed == 1


def test_repair_alone_solves_what_overriding_would(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lazy repair does not lean on the phases before it."""
    monkeypatch.setattr(completing, "override", lambda problem, policy, distances: policy)
    spec = interacting()
    spec = exclusive(spec)
    outcome = synthesize(spec)
    assert judge(spec, rows(outcome), "any").sound_and_complete
    assert outcome.statistics is not None
    assert outcome.statistics.changed == 1


def test_a_limit_ends_in_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    """When repair runs out of rounds the answer is neither yes nor no."""
    monkeypatch.setattr(completing, "override", lambda problem, policy, distances: policy)
    monkeypatch.setattr(import_module("tumato_symbolic.synthesis.repair"), "ROUNDS", 1)
    monkeypatch.setattr(import_module("tumato_symbolic.synthesis.touring"), "MOST_TARGETS", 0)
    spec = interacting()
    outcome = synthesize(exclusive(spec))
    assert isinstance(outcome, Undecided)
    assert "rounds" in outcome.limit


def test_states_without_an_allowed_set_and_without_a_plan_are_told_apart() -> None:
    """Section 7: both kinds are reported at once, each state once."""
    build = Build({"x": "abcd"})
    build.action("x=d", when=[build.atom("x=c")])
    bad = build.atom("x=a")
    spec = build.spec(priority(build.goal(build.atom("x=d"))), state_rules=[Not(bad)])
    outcome = synthesize(spec)
    assert isinstance(outcome, Unrealizable)
    assert [(failure.kind, failure.states) for failure in outcome.failures] == [
        ("no-allowed-set", (build.state("a"),)),
        ("no-plan", (build.state("b"),)),
    ]


def test_no_valid_state_is_an_error_of_the_specification() -> None:
    """Section 1: an empty `V` is an error, with the assumption to blame."""
    build = Build({"x": "ab"})
    with pytest.raises(UserError) as error:
        synthesize(build.spec(assumptions=[build.atom("x=a"), build.atom("x=b")]))
    assert error.value.diagnostics[0].code is Code.TUM312


def test_warnings_that_need_the_state_space() -> None:
    """A hidden goal, one that holds already, a rule that nothing breaks, an action that is never allowed."""
    build = Build({"x": "ab", "y": "ab"})
    build.action("y=b", when=[build.atom("x=b")])
    goals = priority(build.goal(build.atom("x=a")), when(build.atom("y=a"), build.goal(build.atom("y=b"))))
    spec = build.spec(goals, state_rules=[build.atom("x=a")], assumptions=[build.atom("x=a")])
    outcome = synthesize(spec)
    assert sorted(warning.code.name for warning in outcome.warnings) == ["TUM351", "TUM352", "TUM353", "TUM355"]


def test_a_predicate_decided_by_its_own_variables_is_not_reported_twice() -> None:
    """Always-true rules and never-true conditions are found when the text is read."""
    build = Build({"x": "ab"})
    goals = priority(when(FALSE, build.goal(build.atom("x=a"))))
    outcome = synthesize(build.spec(goals, state_rules=[Or((build.atom("x=a"), build.atom("x=b")))]))
    assert outcome.warnings == ()


@pytest.mark.skipif(available_backend() == "autoref", reason="there is only one backend here")
def test_backends_and_formats_agree_byte_for_byte() -> None:
    """The same policy file from CUDD and from pure Python; a diagram holds the same decisions as the table."""
    spec = interacting()
    spec = exclusive(spec)

    def policy(**options: object) -> Policy:
        outcome = synthesize(spec, **options)  # type: ignore[arg-type]
        assert isinstance(outcome, Realizable)
        return outcome.policy

    assert dumps(policy(backend="cudd")) == dumps(policy(backend="autoref"))
    diagram = policy(policy_format="diagram", backend="autoref")
    assert dumps(diagram) == dumps(policy(policy_format="diagram", backend="cudd"))
    assert as_table(diagram, 100) == policy().decisions


def test_tables_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    """Above a limit a policy is a diagram, and a table that is too large is refused with the way out."""
    _, spec = line()
    monkeypatch.setattr(pipeline, "TABLE_LIMIT", 3)
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    assert not isinstance(outcome.policy.decisions, Table)
    monkeypatch.setattr(pipeline, "TABLE_MAXIMUM", 3)
    with pytest.raises(UserError) as error:
        synthesize(spec, policy_format="table")
    assert error.value.diagnostics[0].code is Code.TUM508


@pytest.mark.parametrize("backend", sorted({"autoref", available_backend()}))
def test_a_time_limit_ends_in_undecided(backend: Backend) -> None:
    """Time that is up ends the work at once."""
    _, spec = line()
    outcome = synthesize(spec, backend=backend, context=Context(Limits(seconds=0.0)))
    assert outcome == Undecided("the time limit of 0 s was met while starting", None)


class Expiring(Context):
    """Time is up when a stage begins."""

    def __init__(self, last: str) -> None:
        super().__init__(Limits(seconds=1000.0))
        self._last = last

    def tell(self, stage: str) -> None:
        """Let time be up from the last stage on."""
        super().tell(stage)
        if stage == self._last:
            self.deadline = 0.0


@pytest.mark.parametrize("last", ["solving each goal in its own region", "choosing restoring sets"])
def test_a_time_limit_leaves_what_is_known(last: str) -> None:
    """Undecided says during what time was up, and how many states there are."""
    _, spec = line()
    outcome = synthesize(spec, context=Expiring(last))
    assert isinstance(outcome, Undecided)
    assert outcome.limit == f"the time limit of 1000 s was met while {last}"
    assert outcome.statistics is not None
    assert outcome.statistics.valid == 4


def test_unrealizable_stands_without_its_certificate() -> None:
    """A limit that is met when only the certificate is left takes nothing from the answer."""
    build = Build({"a": "xy"})
    spec = build.spec(state_rules=[FALSE], goals=constraint())
    whole, outcome = synthesize(spec), synthesize(spec, context=Expiring("certifying that there is no policy"))
    assert isinstance(whole, Unrealizable)
    assert isinstance(outcome, Unrealizable)
    assert whole.certificate is not None
    limit = "the time limit of 1000 s was met while certifying that there is no policy"
    assert outcome == replace(whole, certificate=None, limit=limit, restorability=None)


def test_every_step_of_a_fixpoint_heeds_the_time_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """However a step is computed, time is looked at before each: a long plan cannot overrun it."""
    _, spec = line()
    problem = build_problem(spec, "any", available_backend())
    asked: list[int] = []
    monkeypatch.setattr(problem.encoding.manager.context, "check", lambda: asked.append(1))
    steps = problem.steps
    layers = attractor(problem, problem.targets[0].states, lambda states, _: states & steps.safe, steps.safe, None)
    assert len(asked) == len(layers) - 1 > 0


@pytest.mark.skipif(available_backend() == "autoref", reason="only CUDD bounds its memory")
def test_a_memory_limit_ends_in_undecided() -> None:
    """Rules whose diagram is large in any order of the variables run into the limit, not into the ground."""
    boxes = 14
    build = Build({f"v{box}": "abcdefghijklmn" for box in range(boxes)})
    apart = [Not(And((Is(i, p), Is(j, p)))) for i, j in combinations(range(boxes), 2) for p in range(boxes)]
    outcome = synthesize(build.spec(state_rules=apart), context=Context(Limits(megabytes=8)))
    assert isinstance(outcome, Undecided)
    assert "memory limit of 8 MB" in outcome.limit
