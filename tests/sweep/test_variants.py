"""Variants of a text: by other values, without an element, with a mistake."""

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.generate import random_text
from tests.profiles import ALL_PROFILES
from tests.repo.documents import ROOT
from tests.sweep.here import AMR
from tumato_symbolic.diagnostics import Source, UserError
from tumato_symbolic.explain.elements import elements_of, without
from tumato_symbolic.spec import Spec, digest, load
from tumato_symbolic.sweep import Variant, defined, definition, dropped, mutated

FLEET = Source("fleet.tum", (ROOT / "examples" / "fleet.tum").read_text())
TEXTS = [(profile, seed) for profile in ALL_PROFILES for seed in range(4)]


def read(source: Source, variant: Variant) -> Spec:
    """The specification of a variant."""
    loaded = load(Source("variant", variant.text(source)))
    assert loaded.spec is not None, (variant, loaded.diagnostics)
    return loaded.spec


def values(source: Source, *definitions: str) -> tuple[Variant, ...]:
    """The variants of -D options."""
    return defined(source, [definition(each) for each in definitions])


def test_values_of_settings() -> None:
    """Each combination, the first name changing slowest; a setting that is not there is added."""
    variants = values(AMR, "max_plan_length=3, 7", "restoration=bounded,fair")
    found = [(each.max_plan_length, each.restoration) for each in (read(AMR, variant) for variant in variants)]
    assert found == [(5, "one_step"), (3, "bounded"), (3, "fair"), (7, "bounded"), (7, "fair")]
    bare = Source("bare.tum", AMR.text[: AMR.text.index("BEGIN CONFIG")] + "// the end")
    two = values(bare, "max_plan_length=3", "effect_ordering=first")[1]
    assert (read(bare, two).max_plan_length, read(bare, two).effect_ordering) == (3, "first")


def test_values_of_lists() -> None:
    """A list in braces, or one word; as if the text had them."""
    variants = values(FLEET, "FLEET=anna,{anna,bert}", "NARROW={table}")
    assert [change.after for change in variants[2].changes] == ["{anna, bert}", "{table}"]
    written = FLEET.text.replace("{anna, bert, carl}", "{anna, bert}").replace("{table, charger}", "{table}")
    assert variants[2].text(FLEET) == written
    assert len(read(FLEET, variants[1]).variables) < len(read(FLEET, variants[0]).variables)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("max_plan_lenght=3", "did you mean `max_plan_length`"),
        ("S_Battery=ok", "TUM207"),
        ("charge=1", "`charge` is an action"),
        ("restoration=boundd", "did you mean `bounded`"),
        ("max_plan_length=few", "TUM310"),
        ("max_plan_length=0", "TUM310"),
        ("max_plan_length", "TUM113"),
        ("max_plan_length=3,,4", "is missing"),
        ("max_plan_length=3,3", "given twice"),
        ("effect_ordering=any END CONFIG", "TUM113"),
        ("effect_ordering={any", "TUM113"),
        ("=3", "TUM113"),
    ],
)
def test_what_cannot_be_defined(text: str, said: str) -> None:
    """Is a diagnostic with a way out."""
    with pytest.raises(UserError) as error:
        values(AMR, text)
    (diagnostic,) = error.value.diagnostics
    assert said in f"{error.value} {diagnostic.help}"
    assert diagnostic.help


def test_names_given_twice_and_too_many_combinations() -> None:
    """Are refused before any work."""
    with pytest.raises(UserError, match="TUM203"):
        values(AMR, "max_plan_length=3", "max_plan_length=4")
    numbers = ",".join(map(str, range(1, 1001)))
    with pytest.raises(UserError, match="TUM311"):
        values(FLEET, f"max_plan_length={numbers}", f"FLEET={numbers}")


@given(st.text(alphabet="{}, .=ab1END\n/*;BEGI", max_size=30))
def test_no_value_writes_anything_else(text: str) -> None:
    """Whatever is typed, the blocks and their entries stay those of the text."""
    try:
        (_, *variants) = values(FLEET, f"NARROW={text}")
    except UserError:
        return
    for variant in variants:
        written = variant.text(FLEET)
        (change,) = variant.changes
        assert change.after is not None
        assert written == FLEET.text.replace("{table, charger}", change.after)
        assert not set(change.after[1:-1]) & set("{}=/*;\n")


@pytest.mark.parametrize(("profile", "seed"), TEXTS)
def test_dropping_from_the_text_is_dropping_the_element(profile: str, seed: int) -> None:
    """A text without a line means what the specification means without that element."""
    source = Source("random.tum", random_text(seed, ALL_PROFILES[profile]))
    spec = load(source).spec
    assert spec is not None
    kinds = ("state-rule", "reaction-rule", "assumption", "precondition", "alternative")
    expected = sorted(digest(without(spec, [each])) for each in elements_of(spec) if each.kind in kinds)
    assert sorted(digest(read(source, each)) for each in dropped(source)[1:]) == expected


@pytest.mark.parametrize("name", ["amr", "fleet", "sprayer", "nested_goals", "px4_failsafe", "forklift"])
def test_what_stands_in_copies_and_clauses_is_dropped(name: str) -> None:
    """Every variant of an example is a specification, and means something else."""
    source = Source(name, (ROOT / "examples" / f"{name}.tum").read_text())
    meant = [digest(read(source, each)) for each in dropped(source)]
    assert meant[0] not in meant[1:]
    assert all(each.changes[0].after is None for each in dropped(source)[1:])


@pytest.mark.parametrize(("profile", "seed"), TEXTS)
def test_mutations_can_be_read(profile: str, seed: int) -> None:
    """They are specifications; what is wrong with one, if anything, is its meaning and not its syntax."""
    source = Source("random.tum", random_text(seed, ALL_PROFILES[profile]))
    found, possible = mutated(source, "all", 0)
    assert len({each.edits for each in found}) == possible + 1
    for each in Random(seed).sample(found, min(20, len(found))):
        wrong = load(Source("mutation", each.text(source))).diagnostics
        assert not [said for said in wrong if said.code.name.startswith(("TUM1", "TUM2"))], (each, wrong)


@pytest.mark.parametrize("name", ["amr", "fleet", "sprayer", "px4_failsafe"])
def test_mutations_of_examples_change_the_meaning(name: str) -> None:
    """None is in error, none means the same."""
    source = Source(name, (ROOT / "examples" / f"{name}.tum").read_text())
    found, _ = mutated(source, "all", 0)
    spec = load(source).spec
    assert spec is not None
    for each in Random(name).sample(found[1:], 25):
        assert digest(read(source, each)) != digest(spec), each


def test_each_kind_of_mistake_is_there() -> None:
    """In effects, preconditions, rules, goals, resources, the order of goals and the plan bound."""
    found, _ = mutated(AMR, "all", 0)
    changes = [(each.changes[0].what, each.changes[0].before, each.changes[0].after) for each in found[1:]]
    assert ("resource of charge", "MOTORS", None) in changes
    assert ("nominal effect of charge", "S_Battery is ok", "S_Battery is low") in changes
    assert ("precondition of charge", "S_Location is charger", "S_Location is not charger") in changes
    assert ("precondition of charge", "S_Location is charger", None) in changes
    assert ("goal", "S_Battery is ok", "S_Battery is low") in changes
    assert ("plan bound", "max_plan_length: 5", "max_plan_length: 4") in changes
    either, both = ("S_Location is corridor OR S_Location is charger", "AND")
    assert ("state rule", either, f"({either.replace('OR', both)})") in changes
    assert any(what == "order of goals" for what, _, _ in changes)


def test_which_mutations_are_drawn_depends_on_the_seed() -> None:
    """As many as are asked for, in the order of the text, always the same ones."""
    everything, possible = mutated(AMR, "all", 0)
    some, others = (mutated(AMR, 20, seed)[0] for seed in (1, 2))
    assert possible == len(everything) - 1
    assert mutated(AMR, 20, 1)[0] == some
    assert [each.edits for each in some] != [each.edits for each in others]
    kept = [each.edits for each in everything if each.edits in [one.edits for one in some]]
    assert kept == [each.edits for each in some]
    assert len(some) == 21
