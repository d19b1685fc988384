"""JSON text to the fields of a policy. The format is described in `docs/policy.md`."""

from __future__ import annotations

from typing import Any

from tumato_symbolic.diagnostics import Code, Source, UserError
from tumato_symbolic.diagnostics.wording import listed
from tumato_symbolic.diagrams import Diagram, Reference, rebuild
from tumato_symbolic.policy.formats.read_diagrams import read_diagram
from tumato_symbolic.policy.formats.restoring import read_restoring
from tumato_symbolic.policy.records import Certificate, DecisionDiagram, PolicyFields, RankedGoal, Table, Vocabulary
from tumato_symbolic.policy.text import (
    Row,
    as_list,
    as_names,
    as_object,
    as_text,
    as_whole,
    described,
    fault,
    member,
    parse_json,
    show,
    way_out,
    wrong,
)
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Ordering, Restoration

FORMAT_VERSION = 1
"""The version of this project's own sections."""

UNREALIZABLE = "unrealizable"
"""The `Type` of certificates of unrealizability."""


def policy_fields(text: str, name: str) -> PolicyFields:
    """The policy that `text` describes; `name` is what it is called in messages.

    Raises `UserError` (TUM501 to TUM508).
    """
    try:
        return fields_of(as_object(parse_json(text, name), "the policy"))
    except UserError as error:
        raise UserError(error.diagnostics, error.source or Source(name, "")) from None


def fields_of(document: dict[str, Any]) -> PolicyFields:
    """The policy that a JSON object describes. Raises `UserError`."""
    form = as_text(member(document, "Type", "the policy"), "`Type`")
    if form == UNREALIZABLE:
        message = "this is a certificate that a specification has no policy; it decides nothing"
        raise fault(Code.TUM502, message, "check it with `tumato-sym verify`")
    if form not in ("policy", "policy-diagram"):
        raise fault(Code.TUM502, f"`Type` is {show(form)}", 'expected "policy" or "policy-diagram"')
    check_version(document)
    vocabulary = read_vocabulary(document, "the policy")
    body, other = ("Policy", "Diagram") if form == "policy" else ("Diagram", "Policy")
    if other in document:
        raise fault(Code.TUM502, f"a policy of type {show(form)} must not have `{other}`", f"keep `{body}` only")
    section = member(document, body, f"a policy of type {show(form)}")
    decisions = _table(section, vocabulary) if form == "policy" else _decision_diagram(section, vocabulary)
    certificate, problem = _certificate(document, vocabulary)
    ordering, restoration = read_ordering(document), read_restoration(document)
    return PolicyFields(vocabulary, decisions, ordering, read_digest(document), certificate, problem, restoration)


def check_version(document: dict[str, Any]) -> None:
    """Raise `UserError` for a file of another format."""
    if "PolicyFrameworkVersion" in document:
        as_text(document["PolicyFrameworkVersion"], "`PolicyFrameworkVersion`")
    version = as_whole(document.get("FormatVersion", FORMAT_VERSION), "`FormatVersion`")
    if version != FORMAT_VERSION:
        message = f"`FormatVersion` is {version}, this program reads {FORMAT_VERSION}"
        later = "use the version of tumato-sym that wrote it, or a later one" if version > FORMAT_VERSION else None
        raise fault(Code.TUM502, message, later)


def read_ordering(document: dict[str, Any]) -> Ordering | None:
    """The recorded effect ordering."""
    if "EffectOrdering" not in document:
        return None
    match document["EffectOrdering"]:
        case "any":
            return "any"
        case "first":
            return "first"
        case value:
            raise wrong("`EffectOrdering`", '"any" or "first"', value)


def read_restoration(document: dict[str, Any]) -> Restoration:
    """The recorded way to restore safety: in one step where nothing is recorded."""
    match document.get("Restoration", "one_step"):
        case "one_step":
            return "one_step"
        case "bounded":
            return "bounded"
        case "fair":
            return "fair"
        case value:
            raise wrong("`Restoration`", '"one_step", "bounded" or "fair"', value)


def read_digest(document: dict[str, Any]) -> str | None:
    """The recorded digest of the specification."""
    if "SpecificationDigest" not in document:
        return None
    return as_text(document["SpecificationDigest"], "`SpecificationDigest`")


def read_vocabulary(document: dict[str, Any], where: str) -> Vocabulary:
    """The names that the document called `where` uses."""
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


def _table(section: object, vocabulary: Vocabulary) -> Table:
    if any(name == "Actions" for name, _ in vocabulary.variables):
        message = "a table cannot hold a variable named `Actions`: its value and the actions would share one key"
        raise fault(Code.TUM502, message, 'rename the variable, or use the type "policy-diagram"')
    entries = as_list(section, "`Policy`")
    decoder = _RowDecoder(vocabulary)
    rows: dict[State, ActionSet] = {}
    for place, row in enumerate(entries, 1):
        decoded = decoder.decode(row)
        if decoded is None:
            raise _bad_row(row, place, vocabulary)
        state, executed = decoded
        if rows.setdefault(state, executed) != executed:
            earlier = map(decoder.decode, entries)
            first = next(number for number, each in enumerate(earlier, 1) if each is not None and each[0] == state)
            raise _contradiction(vocabulary, state, first, place)
    return Table(dict(sorted(rows.items())))


class _RowDecoder:
    """Rows of a table to numbers."""

    def __init__(self, vocabulary: Vocabulary) -> None:
        self._values = {
            name: {value: number for number, value in enumerate(values)} for name, values in vocabulary.variables
        }
        self._actions = {name: number for number, name in enumerate(vocabulary.actions)}
        self._sets: dict[tuple[str, ...], ActionSet] = {}
        self._names: tuple[str, ...] = ()
        self._columns: list[tuple[int, dict[str, int]]] = []

    def decode(self, row: object) -> tuple[State, ActionSet] | None:
        """The state and its actions; None where the row does not have just what it should."""
        if type(row) is not Row:
            return None
        if row.names is not self._names:
            if row.names != tuple(self._values) and set(row.names) != set(self._values):
                return None
            self._names = row.names
            self._columns = [(row.names.index(name), numbers) for name, numbers in self._values.items()]
        texts = row.texts
        key = tuple(row.actions)
        try:
            state = tuple([numbers[texts[place]] for place, numbers in self._columns])
            executed = self._sets.get(key)
            if executed is None:
                executed = self._sets[key] = frozenset([self._actions[name] for name in key])
        except KeyError:
            return None
        return state, executed


def _bad_row(row: object, place: int, vocabulary: Vocabulary) -> UserError:
    """Why row number `place` cannot be read."""
    where = f"row {place} of `Policy`"
    section = as_object(row, where)
    values = dict(vocabulary.variables)
    for key in section:
        if key != "Actions" and key not in values:
            return fault(
                Code.TUM503, f"{where} has the unknown variable {show(key)}", way_out(key, values, "variables")
            )
    for name, known in values.items():
        if name not in section:
            return fault(Code.TUM503, f"{where} has no value for {show(name)}", f"its values: {listed(known)}")
        value = as_text(section[name], f"{show(name)} in {where}")
        if value not in known:
            message = f"{where} gives {show(name)} the unknown value {show(value)}"
            return fault(Code.TUM504, message, way_out(value, known, "values"))
    for action in as_list(member(section, "Actions", where), f"`Actions` in {where}"):
        name = as_text(action, f"an entry of `Actions` in {where}")
        if name not in vocabulary.actions:
            message = f"{where} executes the unknown action {show(name)}"
            return fault(Code.TUM505, message, way_out(name, vocabulary.actions, "actions"))
    return wrong(where, "a state and its actions", row)


def _contradiction(vocabulary: Vocabulary, state: State, first: int, second: int) -> UserError:
    named = {name: values[value] for (name, values), value in zip(vocabulary.variables, state, strict=True)}
    message = f"rows {first} and {second} of `Policy` decide the same state differently: {described(named)}"
    return fault(Code.TUM506, message, "keep one of the two rows")


def _decision_diagram(value: object, vocabulary: Vocabulary) -> DecisionDiagram:
    where = "`Diagram`"
    section = as_object(value, where)
    order, leaves, nodes = read_diagram(section, "Diagram", vocabulary)
    if leaves != [False, True] or any(type(leaf) is not bool for leaf in leaves):
        raise fault(Code.TUM502, "`Diagram.Leaves` must be [false, true]")
    named = as_object(member(section, "Roots", where), "`Diagram.Roots`")
    known = frozenset(vocabulary.actions)
    for name in named:
        if name not in known:
            message = f"`Diagram.Roots` has the unknown action {show(name)}"
            raise fault(Code.TUM505, message, way_out(name, vocabulary.actions, "actions"))
    end = len(leaves) + len(nodes)
    roots: list[Reference] = []
    for name in vocabulary.actions:
        if name not in named:
            raise fault(Code.TUM505, f"`Diagram.Roots` has no entry for the action {show(name)}")
        roots.append(as_whole(named[name], f"the root of {show(name)}", end))
    roots.append(as_whole(member(section, "Defined", where), "`Diagram.Defined`", end))
    found: Diagram[bool] = Diagram(order, tuple(leaves), nodes)
    diagram, kept = rebuild(found, roots)
    return DecisionDiagram(diagram, kept[:-1], kept[-1])


def _certificate(document: dict[str, Any], vocabulary: Vocabulary) -> tuple[Certificate | None, str | None]:
    """The certificate, or why there is none (nothing to say where the policy brings none)."""
    if "Certificate" not in document:
        return None, None
    try:
        return _ranks(as_object(document["Certificate"], "`Certificate`"), vocabulary), None
    except UserError as error:
        return None, error.diagnostics[0].message


def _ranks(section: dict[str, Any], vocabulary: Vocabulary) -> Certificate:
    where = "`Certificate`"
    order, leaves, nodes = read_diagram(section, "Certificate", vocabulary)
    for leaf in leaves:
        if leaf is not None:
            as_whole(leaf, "an entry of `Certificate.Leaves`")
    if len(set(leaves)) != len(leaves):
        raise fault(Code.TUM502, "`Certificate.Leaves` has an entry twice")
    goals = []
    for number, entry in enumerate(as_list(member(section, "Goals", where), "`Certificate.Goals`"), 1):
        here = f"goal {number} of {where}"
        goal = as_object(entry, here)
        bodies = as_names(member(goal, "Bodies", here), f"`Bodies` of {here}")
        executed = as_names(member(goal, "Executed", here), f"`Executed` of {here}")
        root = as_whole(member(goal, "Root", here), f"`Root` of {here}", len(leaves) + len(nodes))
        goals.append(RankedGoal(bodies, executed, root))
    found: Diagram[int | None] = Diagram(order, tuple(leaves), nodes)
    ranks, roots = rebuild(found, [goal.root for goal in goals])
    kept = zip(goals, roots, strict=True)
    restoring = read_restoring(section["Restoring"], vocabulary) if "Restoring" in section else None
    return Certificate(ranks, tuple(RankedGoal(goal.bodies, goal.executed, root) for goal, root in kept), restoring)
