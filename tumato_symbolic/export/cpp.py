"""A policy as one header in C++17, with a type for each variable: it stands alone, and decides at compile time too."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from string import Template
from textwrap import indent
from typing import Final

from msgspec import Struct

from tumato_symbolic.export.c99_names import WORDS as C_WORDS
from tumato_symbolic.export.c_decisions import statements
from tumato_symbolic.export.identifiers import distinct, identifier
from tumato_symbolic.export.request import Request, commented

_HEADER = Template("""\
// What to do in a state: the decisions of a policy. Written by `tumato-sym export cpp`.
//
$promise

#ifndef $guard
#define $guard

#include <array>
#include <cstdint>

namespace $namespace {

$types/// What a decision depends on. A field that nobody has set has no value: what is decided then is `invalid`.
struct State {
$fields};

enum class Action {
$actions};

/// Every action, in the order of the specification.
inline constexpr std::array<Action, $action_count> all_actions{$all_actions};

/// What the specification calls an action.
constexpr const char* name(Action action) noexcept
{
    switch (action) {
$names    default:
        return "";
    }
}

/// A set of actions, to be executed together.
class Actions {
public:
    constexpr bool contains(Action action) const noexcept
    {
        const auto number = static_cast<unsigned>(action);
        return number < ${action_count}u && (words_[number / 32u] >> (number % 32u) & 1u) != 0u;
    }

    constexpr bool empty() const noexcept
    {
        for (const std::uint32_t word : words_) {
            if (word != 0u) {
                return false;
            }
        }
        return true;
    }

    constexpr void insert(Action action, bool wanted = true) noexcept
    {
        const auto number = static_cast<unsigned>(action);
        if (wanted && number < ${action_count}u) {
            words_[number / 32u] |= std::uint32_t{1} << (number % 32u);
        }
    }

private:
    std::array<std::uint32_t, $words> words_{};
};

enum class Status {
    invalid,   ///< some variable has a value that it cannot have: nothing is decided
    undecided, ///< the policy says nothing of this state: no action is known to be safe
    decided    ///< execute the actions; where there are none, do nothing
};

/// Look at the status first: there are no actions where nothing is to be done, and where nothing is decided.
struct Decision {
    Status status;
    Actions actions;
};

namespace detail {

template <typename... Each>
constexpr Decision execute(Each... each) noexcept
{
    Actions actions{};
    (actions.insert(each), ...);
    return {Status::decided, actions};
}

} // namespace detail

/// What to do in a state.
[[nodiscard]] constexpr Decision decide(const State& state) noexcept
{
$range$decide}

} // namespace $namespace

#endif
""")

_WORDS: Final = f"{C_WORDS} ERROR DELETE IN OUT OPTIONAL VOID CONST DOMAIN OVERFLOW UNDERFLOW SING PLOSS TLOSS".split()
"""Words of the language, and macros that common headers define."""

_OURS: Final = ["State", "Action", "all_actions", "name", "Actions", "Status", "Decision", "detail", "decide"]


class Names(Struct, frozen=True):
    """Identifiers: types and fields of variables; values inside their types, and actions inside `Action`."""

    namespace: str
    types: tuple[str, ...]
    fields: tuple[str, ...]
    values: tuple[tuple[str, ...], ...]
    actions: tuple[str, ...]

    @classmethod
    def of(cls, request: Request) -> Names:
        """The names for a policy; that of the namespace comes from the name of its file."""
        vocabulary = request.policy.vocabulary
        namespace = distinct({"": identifier(request.name)}, [*_WORDS, *_OURS, "std"])[""]
        variables = {name: identifier(name) for name, _ in vocabulary.variables}
        return cls(
            namespace,
            tuple(distinct(variables, [*_WORDS, *_OURS, namespace]).values()),
            tuple(distinct(variables, [*_WORDS, "State", namespace]).values()),
            tuple(_within({value: identifier(value) for value in values}) for _, values in vocabulary.variables),
            _within({action: identifier(action) for action in vocabulary.actions}),
        )


def _within(wanted: dict[str, str]) -> tuple[str, ...]:
    """Enumerators of one type."""
    return tuple(distinct(wanted, _WORDS).values())


def files(request: Request) -> tuple[str]:
    """The text of the header."""
    names, actions = Names.of(request), request.policy.vocabulary.actions
    listed = "".join(f"\n    Action::{action}," for action in names.actions)
    text = _HEADER.substitute(
        promise=commented(request.promise, "// "),
        guard=f"{identifier(request.name).upper()}_HPP",
        namespace=names.namespace,
        types="".join(_types(names)),
        fields="".join(
            f"    {names.namespace}::{each} {field} = {names.namespace}::{each}{{-1}};\n"
            for each, field in zip(names.types, names.fields, strict=True)
        ),
        actions="".join(f"    {action},\n" for action in names.actions),
        action_count=len(actions),
        all_actions=f"{{{listed}\n}}" if actions else "",
        names="".join(
            f'    case Action::{shown}:\n        return "{action}";\n'
            for shown, action in zip(names.actions, actions, strict=True)
        ),
        words=max(1, -(-len(actions) // 32)),
        range=indent("".join(_range_check(names)), "    "),
        decide="".join(f"    {line}\n" for line in statements(request.policy, _Cpp(names))),
    )
    return (text,)


def _types(names: Names) -> Iterator[str]:
    for type_, values in zip(names.types, names.values, strict=True):
        yield f"enum class {type_} {{\n{''.join(f'    {value},{chr(10)}' for value in values)}}};\n\n"


def _range_check(names: Names) -> Iterator[str]:
    checks = [
        f"static_cast<unsigned>(state.{field}) >= {len(values)}u"
        for field, values in zip(names.fields, names.values, strict=True)
    ]
    yield "if (" + "\n    || ".join(checks) + ") {\n    return {Status::invalid, {}};\n}\n"


class _Cpp(Struct, frozen=True):
    """The style of C++: see `Style`."""

    names: Names

    def field(self, variable: int) -> str:
        """A field of the state."""
        return f"state.{self.names.fields[variable]}"

    def label(self, variable: int, value: int) -> str:
        """An enumerator."""
        return f"{self.names.types[variable]}::{self.names.values[variable][value]}"

    def number(self, variable: int) -> str:
        """A cast."""
        return f"static_cast<unsigned>({self.field(variable)})"

    def answer(self, actions: tuple[int, ...] | None) -> Iterator[str]:
        """One statement."""
        if actions is None:
            yield "return {Status::undecided, {}};"
        else:
            yield f"return detail::execute({', '.join(f'Action::{self.names.actions[each]}' for each in actions)});"

    def answer_by(self, executed: Sequence[str]) -> Iterator[str]:
        """A set to which each action is added, or not."""
        yield "Actions actions{};"
        for action, wanted in zip(self.names.actions, executed, strict=True):
            if wanted != "false":
                yield f"actions.insert(Action::{action}, {wanted});"
        yield "return {Status::decided, actions};"
