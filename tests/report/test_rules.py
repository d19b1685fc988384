"""Rules as text and as JSON."""

from tumato_symbolic.diagnostics import Source
from tumato_symbolic.policy import Rule, RuleList
from tumato_symbolic.report.rules import condition, rule_lines, rules_json
from tumato_symbolic.semantics import all_states, holds
from tumato_symbolic.spec import load

VALUES = {"S_A": ("x", "y", "z", "w"), "S_B": ("on", "off"), "S_C": tuple("abcdefgh")}


def test_conditions_group_values_and_exclude_where_that_is_shorter() -> None:
    """Several values of one variable are a set, unless they are all there is; few missing ones are excluded."""
    cases = [
        ((), "otherwise"),
        ((("S_A", ("x", "z")),), "S_A in {x, z}"),
        ((("S_A", ("x", "y", "z")),), "S_A is not w"),
        ((("S_A", ("x", "z")), ("S_B", ("on",))), "S_A in {x, z} AND S_B is on"),
        ((("S_A", ("x", "y", "z")), ("S_B", ("off",))), "S_A is not w AND S_B is off"),
        ((("S_C", tuple("abcdef")),), "S_C not in {g, h}"),
    ]
    for given, expected in cases:
        assert condition(VALUES, Rule(given, ())) == expected


def test_the_text_shows_order_and_actions() -> None:
    """Rules are numbered; no action is `(nothing)`."""
    rules = (Rule((("S_B", ("on",)),), ("go", "stop")), Rule((), ()))
    text = "\n".join(rule_lines(VALUES, RuleList(rules), 8))
    assert text == (
        "2 rules decide the same. The first that matches decides.\n\n"
        "1  S_B is on\n     go, stop\n2  otherwise\n     (nothing)"
    )


def test_the_object_for_programs() -> None:
    """Conditions are lists of values by variable, the last one is empty."""
    rules = (Rule((("S_B", ("on",)),), ("go",)), Rule((), ()))
    assert rules_json(RuleList(rules))["rules"] == [
        {"condition": {"S_B": ["on"]}, "actions": ["go"]},
        {"condition": {}, "actions": []},
    ]


def test_conditions_are_predicates_of_the_language() -> None:
    """A printed condition, read as a state rule, holds exactly where the rule matches."""
    for given in [
        (("S_A", ("x", "z")), ("S_B", ("on",))),
        (("S_A", ("x", "y", "z")), ("S_B", ("off",))),
        (("S_A", ("x", "z")),),
        (("S_C", tuple("abcdef")),),
    ]:
        shown = condition(VALUES, Rule(given, ()))
        states = "\n".join(f"state {name} can be {', '.join(values)}" for name, values in VALUES.items())
        text = f"BEGIN STATE VECTOR\n{states}\nEND STATE VECTOR\nBEGIN STATE RULES\nrule: {shown}\nEND STATE RULES\n"
        spec = load(Source("t.tum", text)).spec
        assert spec is not None
        for state in all_states(spec):
            named = {
                variable.name: variable.values[value] for variable, value in zip(spec.variables, state, strict=True)
            }
            matches = all(named[name] in values for name, values in given)
            assert holds(spec.state_rules[0].formula, state, frozenset()) == matches
