"""Rules as text and as JSON."""

from tumato_symbolic.diagnostics import Source
from tumato_symbolic.policy import Rule, RuleList, Vocabulary
from tumato_symbolic.report.rules import as_json, as_text, condition
from tumato_symbolic.semantics import all_states, holds
from tumato_symbolic.spec import load

VALUES = {"S_A": ("x", "y", "z", "w"), "S_B": ("on", "off")}


def test_conditions_group_values_and_exclude_where_that_is_shorter() -> None:
    """Several values of one variable stand in brackets, unless they are all there is; few missing ones are excluded."""
    cases = [
        ((), "otherwise"),
        ((("S_A", ("x", "z")),), "S_A is x OR S_A is z"),
        ((("S_A", ("x", "y", "z")),), "NOT S_A is w"),
        ((("S_A", ("x", "z")), ("S_B", ("on",))), "(S_A is x OR S_A is z) AND S_B is on"),
        ((("S_A", ("x", "y", "z")), ("S_B", ("off",))), "NOT S_A is w AND S_B is off"),
    ]
    for given, expected in cases:
        assert condition(VALUES, Rule(given, ())) == expected


def test_the_text_shows_order_and_actions() -> None:
    """Rules are numbered; no action is `(nothing)`; an empty policy has no rules."""
    vocabulary = Vocabulary(tuple(VALUES.items()), ("go", "stop"))
    rules = (Rule((("S_B", ("on",)),), ("go", "stop")), Rule((), ()))
    text = as_text("p.json", vocabulary, RuleList(rules), 8)
    assert text == (
        "p.json decides 8 states; 2 rules decide the same. The first that matches decides.\n\n"
        "1  S_B is on\n     go, stop\n2  otherwise\n     (nothing)"
    )
    assert as_text("p.json", vocabulary, RuleList(()), 0) == "p.json decides 0 states: there are no rules."


def test_the_object_for_programs() -> None:
    """Conditions are lists of values by variable, the last one is empty."""
    rules = (Rule((("S_B", ("on",)),), ("go",)), Rule((), ()))
    assert as_json("p.json", RuleList(rules), 8)["rules"] == [
        {"condition": {"S_B": ["on"]}, "actions": ["go"]},
        {"condition": {}, "actions": []},
    ]


def test_conditions_are_predicates_of_the_language() -> None:
    """A printed condition, read as a state rule, holds exactly where the rule matches."""
    for given in [
        (("S_A", ("x", "z")), ("S_B", ("on",))),
        (("S_A", ("x", "y", "z")), ("S_B", ("off",))),
        (("S_A", ("x", "z")),),
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
