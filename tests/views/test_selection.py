"""What may be typed to name a part of a policy."""

import pytest

from tests.policy.strategies import amr_like
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import Vocabulary
from tumato_symbolic.views import Selection, parse_selection

VOCABULARY = amr_like().vocabulary


@pytest.mark.parametrize(
    ("words", "values"),
    [
        ("", ()),
        ("S_Load=free", (("S_Load", ("free",)),)),
        ("S_Load=odd,free", (("S_Load", ("free", "odd")),)),
        ("S_Load!=odd", (("S_Load", ("free", "full")),)),
        ("S_Load!=odd S_Load!=free", (("S_Load", ("full",)),)),
        ("S_Load=free,full,odd", ()),
        ("S_Load=full S_Place=hall", (("S_Place", ("hall",)), ("S_Load", ("full",)))),
    ],
)
def test_values_and_sets_of_them(words: str, values: tuple[tuple[str, tuple[str, ...]], ...]) -> None:
    """Words about one variable are taken together; the order is that of declaration."""
    assert parse_selection(VOCABULARY, words.split()) == Selection(values)


def test_a_value_may_have_a_comma_in_it() -> None:
    """A value of the policy is taken as it stands."""
    vocabulary = Vocabulary((("S", ("a,b", "a", "c")),), ())
    assert parse_selection(vocabulary, ["S=a,b"]).values == (("S", ("a,b",)),)
    assert parse_selection(vocabulary, ["S=a,c"]).values == (("S", ("a", "c")),)


def test_actions() -> None:
    """They come in the order of declaration."""
    assert parse_selection(VOCABULARY, [], "stop, go").executing == ("go", "stop")


@pytest.mark.parametrize(
    ("words", "executing", "said"),
    [
        ("S_Lod=free", "", "did you mean `S_Load`?"),
        ("S_Load=fre", "", "did you mean `free`?"),
        ("S_Load=free,ful", "", "did you mean `full`?"),
        ("S_Load!=fre", "", "did you mean `free`?"),
        ("S_Load", "", "write S_Load=free"),
        ("Load", "", "write VARIABLE=VALUE, or name a specification that exists"),
        ("S_Load=free S_Load=odd", "", "no value is left for `S_Load`"),
        ("", "stp", "did you mean `stop`?"),
        ("", "fly", "its actions: `go`, `load` and `stop`"),
    ],
)
def test_mistakes_have_a_way_out(words: str, executing: str, said: str) -> None:
    """The nearest name, or all of them."""
    with pytest.raises(UserError) as caught:
        parse_selection(VOCABULARY, words.split(), executing)
    (found,) = caught.value.diagnostics
    assert said in f"{found.message}\n{found.help}"
