"""Binding gives a policy the numbers of a specification and changes nothing else."""

from itertools import product
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.policy.strategies import QUICK, amr_like, certificate_of, policies, rows_of, spec_of
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import Certificate, Policy, RankedGoal, Table, Vocabulary, bind


def shuffled(vocabulary: Vocabulary, random: Random) -> Vocabulary:
    """The same names in another order."""
    variables = [(name, tuple(random.sample(values, len(values)))) for name, values in vocabulary.variables]
    actions = random.sample(vocabulary.actions, len(vocabulary.actions))
    random.shuffle(variables)
    return Vocabulary(tuple(variables), tuple(actions))


def meaning(policy: Policy) -> dict[frozenset[tuple[str, str]], set[str]]:
    """The decisions by names alone."""
    return {
        frozenset(
            (name, values[value]) for (name, values), value in zip(policy.vocabulary.variables, state, strict=True)
        ): {policy.vocabulary.actions[action] for action in chosen}
        for state, chosen in rows_of(policy).items()
    }


def ranks(policy: Policy) -> list[dict[frozenset[tuple[str, str]], int | None]]:
    """The certificate by names alone."""
    certificate, variables = certificate_of(policy), policy.vocabulary.variables
    return [
        {
            frozenset(
                (n, v[value]) for (n, v), value in zip(variables, state, strict=True)
            ): certificate.ranks.evaluate(goal.root, state)
            for state in product(*map(range, policy.vocabulary.sizes))
        }
        for goal in certificate.goals
    ]


@QUICK
@given(policies(), st.randoms(use_true_random=False))
def test_order_never_matters(policy: Policy, random: Random) -> None:
    """Variables, values and actions of the specification may come in any order."""
    target = shuffled(policy.vocabulary, random)
    bound = bind(policy, spec_of(target))
    assert bound.vocabulary == target
    assert meaning(bound) == meaning(policy)
    assert (bound.ordering, bound.digest) == (policy.ordering, policy.digest)
    if policy.certificate is not None:
        assert ranks(bound) == ranks(policy)


@QUICK
@given(policies(), st.randoms(use_true_random=False))
def test_binding_back_gives_the_policy(policy: Policy, random: Random) -> None:
    """Binding to a permuted specification and back is the identity."""
    target = shuffled(policy.vocabulary, random)
    assert bind(bind(policy, spec_of(target)), spec_of(policy.vocabulary)) == policy


AMR = amr_like().vocabulary
PLACE, LOAD = AMR.variables


@pytest.mark.parametrize(
    ("vocabulary", "code", "message"),
    [
        (Vocabulary((PLACE,), AMR.actions), "TUM503", "variable `S_Load`, which the specification does not have"),
        (Vocabulary((PLACE, LOAD, ("S_New", ("a",))), AMR.actions), "TUM503", "lacks the variable `S_New`"),
        (Vocabulary((PLACE, ("S_Load", ("free", "full"))), AMR.actions), "TUM504", "a value `odd` of `S_Load`"),
        (Vocabulary((PLACE, ("S_Load", (*LOAD[1], "x"))), AMR.actions), "TUM504", "lacks the value `x` of `S_Load`"),
        (Vocabulary(AMR.variables, ("go", "load")), "TUM505", "the action `stop`, which the specification does not"),
        (Vocabulary(AMR.variables, (*AMR.actions, "fly")), "TUM505", "lacks the action `fly`"),
    ],
)
@pytest.mark.parametrize("diagram", [False, True])
def test_what_only_one_side_has_is_an_error(vocabulary: Vocabulary, code: str, message: str, diagram: bool) -> None:
    """Unknown and missing variables, values and actions are refused, with the name."""
    with pytest.raises(UserError) as raised:
        bind(amr_like(diagram), spec_of(vocabulary))
    assert [diagnostic.code.name for diagnostic in raised.value.diagnostics] == [code]
    assert message in raised.value.diagnostics[0].message


def test_all_differences_are_reported_with_a_way_out() -> None:
    """Several differences are reported in one run, the nearest name as help."""
    target = Vocabulary((("S_Plaze", PLACE[1]), LOAD), ("go", "lode", "stop"))
    with pytest.raises(UserError) as raised:
        bind(amr_like(), spec_of(target))
    helps = [diagnostic.help for diagnostic in raised.value.diagnostics]
    assert len(helps) == 4
    assert helps[0] == "did you mean `S_Plaze`?"
    assert helps[2] == "did you mean `lode`?"


def test_all_known_names_are_told_where_none_is_near() -> None:
    """Of variables, of the values of the same variable, and of actions."""
    target = Vocabulary((("Q", ("u", "v")), ("S_Load", ("full", "empty"))), ("wave",))
    source = Vocabulary((("Zebra", ("u", "v")), ("S_Load", ("full", "empty", "xyzzy"))), ("wave", "jump"))
    with pytest.raises(UserError) as raised:
        bind(Policy(source, Table({})), spec_of(target))
    helps = [diagnostic.help for diagnostic in raised.value.diagnostics]
    assert helps[:2] == [
        "variables of the specification: `Q` and `S_Load`",
        "values in the specification: `full` and `empty`",
    ]
    assert helps[3] == "actions of the specification: `wave`"


def test_a_certificate_of_unknown_actions_is_set_aside() -> None:
    """The policy stays usable when its certificate mentions an action that nobody has."""
    policy = amr_like()
    certificate = certificate_of(policy)
    goal = certificate.goals[0]
    strange = Certificate(certificate.ranks, (RankedGoal(goal.bodies, ("fly",), goal.root),))
    bound = bind(Policy(policy.vocabulary, policy.decisions, certificate=strange), spec_of(AMR))
    assert bound.certificate is None
    assert "`fly`" in (bound.certificate_problem or "")
    assert bound.decisions == policy.decisions
