"""What a correct text becomes."""

from tests.spec.marked import FULL, VECTOR, codes, loaded
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.spec import And, Constant, Executing, Iff, Is, Not, Or, Spec, load

A, B, X = Is(0, 0), Is(0, 1), Is(1, 0)


def spec(text: str) -> Spec:
    """The specification of a text without errors."""
    found = loaded(text)
    assert found.spec is not None, found.diagnostics
    return found.spec


def formula(predicate: str, aliases: str = "") -> object:
    """What a reaction rule means; `go` is action 0."""
    text = f"{FULL}BEGIN ALIASES {aliases} END ALIASES BEGIN REACTION RULES rule: {predicate} END REACTION RULES"
    return spec(text).reaction_rules[0].formula


def test_operators_bind_as_documented() -> None:
    """IFONLYIF is loosest, then IF, OR, AND, NOT; an implication is a disjunction."""
    assert formula("NOT S is a AND T is x OR S is b") == Or((And((Not(A), X)), B))
    assert formula("IF S is a OR T is x THEN S is b AND T is x") == Or((Not(Or((A, X))), And((B, X))))
    assert formula("IF S is a THEN S is b IFONLYIF T is x") == Iff(Or((Not(A), B)), X)
    assert formula("NOT NOT S is a") == Not(Not(A))
    assert formula("S is a AND (S is b AND T is x)") == And((A, And((B, X))))
    assert formula("true OR executing go") == Or((Constant(True), Executing(0)))


def test_aliases_are_expanded() -> None:
    """An alias may use aliases that are defined later, and may say `executing` where that is allowed."""
    assert formula("p AND S is b", "define p as q OR S is a define q as executing go") == And(
        (Or((Executing(0), A)), B)
    )


def test_keywords_are_soft() -> None:
    """Words of the language name values, variables, actions and resources wherever that is unambiguous."""
    text = """
    BEGIN STATE VECTOR
    state effects can be true, false, on, goal, none
    state cost can be state, is, END_
    END STATE VECTOR
    BEGIN RESOURCES resource duration resource rule END RESOURCES
    BEGIN ACTIONS
    action preconditions controlled resources: duration, rule
    preconditions: effects is true, cost is state nominal effects: cost is is
    action action preconditions: nominal effects: effects is goal
    END ACTIONS
    BEGIN GOALS goal type: constraint goal: effects is none AND executing action END GOALS
    """
    found = spec(text)
    assert [each.name for each in found.actions] == ["preconditions", "action"]
    assert [each.nominal for each in found.actions] == [((1, 1),), ((0, 3),)]
    assert found.actions[0].resources == {0, 1}
    assert found.bodies[0].formula == And((Is(0, 4), Executing(1)))


def test_older_spellings_and_layouts() -> None:
    """`cost:` and `effects:`, blocks and fields in any order, a space before a colon, comments, Windows line ends."""
    newer = f"""{VECTOR}
    BEGIN ACTIONS action go duration: 3 preconditions: S is a nominal effects: S is b END ACTIONS
    BEGIN STATE RULES rule: S is a END STATE RULES"""
    older = f"""BEGIN STATE RULES rule : S is /* really */ a // yes\r\n END STATE RULES
    BEGIN ACTIONS action go effects : S is b\r\n preconditions : S is a cost : 3 END ACTIONS {VECTOR}"""
    first, second = spec(newer), spec(older)
    assert first.state_rules[0].formula == second.state_rules[0].formula
    assert first.actions[0].nominal == second.actions[0].nominal == ((0, 1),)
    assert first.actions[0].duration == second.actions[0].duration == 3


def test_lists_may_be_empty_or_none() -> None:
    """`none`, and nothing at all, mean no condition and no change."""
    for nothing in ("none", ""):
        action = f"action go controlled resources: {nothing} preconditions: {nothing} nominal effects: {nothing}"
        found = spec(f"{VECTOR} BEGIN ACTIONS {action} alternative effects: {nothing} END ACTIONS").actions[0]
        assert (found.resources, found.preconditions, found.nominal) == (frozenset(), (), ())
        assert found.alternatives[0].outcomes == ((),)


def test_blocks_may_be_empty() -> None:
    """Every block but the state vector may hold nothing."""
    titles = ["ALIASES", "RESOURCES", "ACTIONS", "REACTION RULES", "STATE RULES", "ASSUMPTIONS", "START", "GOALS"]
    found = spec(VECTOR + "".join(f" BEGIN {title} END {title}" for title in [*titles, "CONFIG"]))
    assert (found.actions, found.goals, found.max_plan_length, found.starts) == ((), None, None, ())


def test_effects_are_assignments() -> None:
    """Nominal effects denote one assignment; alternative effects may denote several, each an outcome of its own."""
    fields = "nominal effects: NOT S is a, T is x OR T is y, NOT T is y alternative effects: S is a OR T is z"
    found = spec(f"{VECTOR} BEGIN ACTIONS action go {fields} END ACTIONS").actions[0]
    assert found.nominal == ((0, 1), (1, 0))
    assert found.alternatives[0].outcomes == (((0, 0), (1, 0)), ((0, 0), (1, 1)), ((0, 0), (1, 2)), ((0, 1), (1, 2)))
    assert found.alternatives[0].text == "S is a OR T is z"


def test_text_is_the_users_own() -> None:
    """The text of a rule is what stands in the file, white space collapsed and comments left out."""
    rule = "IF S is a\n  THEN ( S is b // why\n OR /* x */ T is x )"
    found = spec(f"{VECTOR} BEGIN STATE RULES rule: {rule} END STATE RULES")
    assert found.state_rules[0].text == "IF S is a THEN ( S is b OR T is x )"


def test_equal_goal_bodies_are_one() -> None:
    """Bodies are numbered by structure, aliases expanded; nested lists keep their kind."""
    text = f"""{VECTOR} BEGIN ALIASES define p as S is a END ALIASES
    BEGIN GOALS goal type: priority
    when S is b then goal: p
    when T is x then BEGIN GOALS goal type: constraint goal: S is a goal: T is y END GOALS
    goal: (S is a)
    END GOALS"""
    found = spec(text)
    assert [body.formula for body in found.bodies] == [A, Is(1, 1)]
    assert found.goals is not None
    assert found.goals.kind == "priority"


def test_a_deep_but_allowed_predicate_is_safe_to_compare() -> None:
    """Formulas at the bound of depth can be hashed and compared under the default recursion limit."""
    text = f"{VECTOR} BEGIN STATE RULES rule: {'NOT ' * 99} S is a END STATE RULES"
    first, second = spec(text), spec(text)
    assert first == second
    assert hash(first.state_rules[0].formula) == hash(second.state_rules[0].formula)


def test_nothing_is_said_about_a_clean_specification() -> None:
    """A complete specification has no diagnostics."""
    assert codes(FULL) == []
    assert load(Source("s", FULL)).spec is not None
