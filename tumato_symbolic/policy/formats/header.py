"""What policies and certificates begin with: the version of the format, what they are for, and their names."""

from __future__ import annotations

from collections.abc import Iterator
from json import dumps as _json
from typing import Any

from tumato_symbolic.diagnostics import Code
from tumato_symbolic.policy.formats.kinds import TEXT, TEXTS, Kind, Names, Schema, one_of
from tumato_symbolic.policy.formats.tables import NEEDED, Attributes, Block, Field, Part, Place, block, described
from tumato_symbolic.policy.records import Vocabulary
from tumato_symbolic.policy.text import as_names, as_object, as_text, as_whole, fault, member, show

FORMAT_VERSION = 1
"""The version of this project's own sections."""

STATES: Schema = {
    "type": "object",
    "minProperties": 1,
    "additionalProperties": {
        "type": "object",
        "minProperties": 1,
        "additionalProperties": {"type": "integer", "minimum": 0},
    },
}


def type_of_file(word: str) -> Field:
    """The key `Type` of a file that is always of one."""

    def read(value: object, where: str, _: Names) -> None:
        form = as_text(value, where)
        if form != word:
            raise fault(Code.TUM502, f"{where} is {show(form)}", f'expected "{word}"')

    return Field("Type", Kind(read, lambda _, __: word, {"const": word}), name="")


def version(about: str = "", default: object = FORMAT_VERSION) -> Field:
    """The version of the format; another one cannot be read."""
    return Field("FormatVersion", _VERSION, about, "", default)


def _check_version(value: object, where: str, _: Names) -> None:
    found = as_whole(value, where)
    if found != FORMAT_VERSION:
        message = f"{where} is {found}, this program reads {FORMAT_VERSION}"
        later = "use the version of tumato-sym that wrote it, or a later one" if found > FORMAT_VERSION else None
        raise fault(Code.TUM502, message, later)


_VERSION = Kind[None](_check_version, lambda _, __: FORMAT_VERSION, {"const": FORMAT_VERSION})


def digest(about: str = "", default: object = NEEDED) -> Field:
    """The digest of the specification."""
    return Field("SpecificationDigest", TEXT, about, "digest", default)


def ordering(about: str = "", default: object = NEEDED) -> Field:
    """The effect ordering."""
    return Field("EffectOrdering", one_of("any", "first"), about, "ordering", default)


def restoration(about: str = "", default: object = "one_step") -> Field:
    """How safety is restored."""
    return Field("Restoration", one_of("one_step", "bounded", "fair"), about, default=default)


class VocabularyPart(Part):
    """The keys `Actions` and `States`; what is read after them means these names."""

    def __init__(self, actions: str = "", states: str = "") -> None:
        self._about = actions, states

    def read(self, section: dict[str, Any], place: Place, names: Names) -> dict[str, Any]:
        """See `Part`."""
        found = _vocabulary(section, place.name)
        names.use(found)
        return {"vocabulary": found}

    def blocks(self, record: Attributes, names: Names, indent: str) -> Iterator[Block]:  # noqa: ARG002 - as `Part` says
        """See `Part`."""
        vocabulary = names.vocabulary
        yield block(f'{indent}"Actions": [', map(_json, vocabulary.actions), "]")
        entries = (
            f"{_json(name)}: {_json({value: number for number, value in enumerate(values)})}"
            for name, values in vocabulary.variables
        )
        yield block(f'{indent}"States": {{', entries, "}")

    def describe(self) -> tuple[dict[str, Schema | bool], list[str]]:
        """See `Part`."""
        actions, states = self._about
        return {"Actions": described(actions, TEXTS.schema), "States": described(states, STATES)}, ["Actions", "States"]


def _vocabulary(document: dict[str, Any], where: str) -> Vocabulary:
    actions = as_names(member(document, "Actions", where), "`Actions`")
    states = as_object(member(document, "States", where), "`States`")
    if not states:
        raise fault(Code.TUM502, "`States` names no variable")
    variables, first = [], _first_index(states)
    for variable, section in states.items():
        here = f"{show(as_text(variable, 'a variable'))} in `States`"
        numbered = as_object(section, here)
        if not numbered:
            raise fault(Code.TUM502, f"{here} has no values")
        variables.append((variable, _numbered(numbered, here, first)))
    return Vocabulary(tuple(variables), actions)


def _first_index(states: dict[str, Any]) -> int:
    """The index with which values are numbered from: 1 where the document never says 0, otherwise 0."""
    sections = [section for section in states.values() if isinstance(section, dict)]
    return int(all(index != 0 for section in sections for index in section.values()))


def _numbered(section: dict[str, Any], where: str, first: int) -> tuple[str, ...]:
    """The values of a variable, in the order of their indices, which begin with `first`."""
    values: dict[int, str] = {}
    for value, index in section.items():
        as_text(value, f"a value of {where}")
        here = f"the index of {show(value)} of {where}"
        if not first <= as_whole(index, here) < first + len(section):
            wanted = f"a number from {first} to {first + len(section) - 1}"
            raise fault(Code.TUM502, f"{here} is {index}, expected {wanted}")
        if values.setdefault(index, value) != value:
            raise fault(Code.TUM502, f"{where} gives {show(values[index])} and {show(value)} the index {index}")
    return tuple(values[first + place] for place in range(len(values)))
