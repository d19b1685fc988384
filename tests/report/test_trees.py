"""Pictures of policies tell the truth."""

from hypothesis import given, settings
from hypothesis import strategies as st

from tumato_symbolic import parse
from tumato_symbolic.policy import Vocabulary, policy_from_rows
from tumato_symbolic.report.trees import table_lines, tree_lines
from tumato_symbolic.semantics import ActionSet, State, all_states, is_safe, named
from tumato_symbolic.views import Questions, Selection, select

SPEC = parse("""
BEGIN STATE VECTOR
state A can be x, y, z
state B can be on, off
state C can be low, middle, high
END STATE VECTOR
BEGIN ACTIONS
action go preconditions: none effects: none
action stop preconditions: none effects: none
END ACTIONS
BEGIN STATE RULES
rule: NOT (A is x AND B is on)
END STATE RULES
""")
STATES = list(all_states(SPEC))

_policies = st.dictionaries(st.sampled_from(STATES), st.frozensets(st.integers(0, 1)), min_size=1)


def _tree(rows: dict[State, ActionSet], most: int = 1_000) -> list[str]:
    tree = Questions(select(policy_from_rows(SPEC, rows), spec=SPEC).joint()).tree(most)
    assert tree is not None
    return tree_lines(Vocabulary.of(SPEC), tree)


def _read(lines: list[str], state: State) -> str:
    """What a person reads off a picture: follow the questions that are answered with yes."""
    values, depth = named(SPEC, state), 0
    for line in lines:
        indent = (len(line) - len(line.lstrip())) // 2
        if indent != depth:
            continue
        variable, _, rest = line.strip().partition(" ")
        question, _, answer = rest.partition("  ")
        if variable == "always":
            return rest.strip()
        if values[variable] in question.strip().split(" or "):
            if answer.strip():
                return answer.strip()
            depth += 1
    raise AssertionError(f"no answer for {values}")


@settings(max_examples=200)
@given(_policies)
def test_a_picture_says_what_the_policy_says(rows: dict[State, ActionSet]) -> None:
    """Following the questions from any state leads to its actions, if it is decided, and to `!` where it is unsafe."""
    lines = _tree(rows)
    for state in STATES:
        names = [SPEC.actions[number].name for number in sorted(rows.get(state, ()))]
        actions = ", ".join(names) or "(nothing)" if state in rows else "(undecided)"
        mark = "" if is_safe(SPEC, state) else "! "
        assert _read(lines, state) == mark + actions


def test_a_question_that_does_not_matter_is_not_asked() -> None:
    """Only variables that make a difference appear."""
    off = [state for state in STATES if state[1] == 1]
    policy = policy_from_rows(SPEC, {state: frozenset({0} if state[2] == 1 else {1}) for state in off})
    tree = Questions(select(policy, Selection((("B", ("off",)),))).joint()).tree(9)
    assert tree is not None
    assert tree_lines(policy.vocabulary, tree) == ["C low or high    stop", "C middle         go"]


def test_a_policy_of_one_decision_needs_no_question() -> None:
    """One set everywhere is one line, and one row."""
    policy = policy_from_rows(SPEC, dict.fromkeys(STATES, frozenset({0})))
    tree = Questions(select(policy).joint()).tree(1)
    assert tree is not None
    assert tree_lines(policy.vocabulary, tree) == ["always    go"]
    assert table_lines(policy.vocabulary, tree) == ["states    actions", "──────  ─────────", "    18    go"]
