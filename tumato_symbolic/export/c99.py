"""A policy as a header and a source in C99: no memory is allocated, and nothing else is needed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from string import Template
from textwrap import indent

from msgspec import Struct

from tumato_symbolic.export.c99_check import check
from tumato_symbolic.export.c99_names import Names
from tumato_symbolic.export.c_decisions import statements
from tumato_symbolic.export.request import Request, commented

_HEADER = Template("""\
/* What to do in a state: the decisions of a policy. Written by `tumato-sym export c99`.

$promise */

#ifndef ${guard}
#define ${guard}

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

${types}typedef struct {
$fields} ${p}_state;

typedef enum {
$actions    ${u}_ACTION_COUNT
} ${p}_action;

enum { ${u}_WORD_COUNT = $words };

/* A set of actions, executed together; ask ${p}_executes. No bit is set where nothing is to be done, and where nothing
   is decided: only the status tells them apart. */
typedef struct {
    uint32_t words[${u}_WORD_COUNT];
} ${p}_actions;

typedef enum {
    ${u}_INVALID,   /* some variable has a value that it cannot have: nothing is decided */
    ${u}_UNDECIDED, /* the policy says nothing of this state: no action is known to be safe */
    ${u}_DECIDED    /* execute the set of actions, which may be empty */
} ${p}_status;

/* What to do in a state. */
${p}_status ${p}_decide(const ${p}_state *state, ${p}_actions *actions);

/* Whether an action is in a set. */
static inline bool ${p}_executes(const ${p}_actions *actions, ${p}_action action)
{
    return (unsigned)action < (unsigned)${u}_ACTION_COUNT
        && (actions->words[(unsigned)action / 32u] >> ((unsigned)action % 32u) & 1u) != 0u;
}

#ifdef __cplusplus
}
#endif

#endif
""")

_SOURCE = Template("""\
/* The decisions of a policy. Written by `tumato-sym export c99`; see $header. */

#include "$header"

${p}_status ${p}_decide(const ${p}_state *state, ${p}_actions *actions)
{
$clear
    if ($invalid) {
        return ${u}_INVALID;
    }
$decide}
""")


def files(request: Request) -> tuple[str, ...]:
    """The texts of the source, of the header, and of the program that checks them where it is asked for."""
    names = Names.of(request)
    header = _HEADER.substitute(
        promise=commented(request.promise, "   "),
        guard=f"{names.upper}_H",
        p=names.prefix,
        u=names.upper,
        types="".join(_types(names)),
        fields="".join(_fields(names)),
        actions="".join(f"    {action},\n" for action in names.actions),
        words=names.words,
    )
    source = _SOURCE.substitute(
        header=f"{request.name}.h",
        p=names.prefix,
        u=names.upper,
        clear=indent("\n".join(f"actions->words[{word}] = 0u;" for word in range(names.words)), "    "),
        invalid="\n        || ".join(_range_checks(names)) or "state == (void *)0",
        decide="".join(f"    {line}\n" for line in statements(request.policy, _C(names))),
    )
    return (source, header, check(request)) if request.check else (source, header)


def _types(names: Names) -> Iterator[str]:
    for variable, type_ in enumerate(names.types):
        values = ",\n".join(f"    {value}" for value in names.values[variable])
        yield f"typedef enum {{\n{values}\n}} {type_};\n\n"


def _fields(names: Names) -> Iterator[str]:
    for type_, field in zip(names.types, names.fields, strict=True):
        yield f"    {type_} {field};\n"
    if not names.fields:
        yield "    char nothing;\n"


def _range_checks(names: Names) -> Iterator[str]:
    for field, values in zip(names.fields, names.values, strict=True):
        yield f"(unsigned)state->{field} >= {len(values)}u"


class _C(Struct, frozen=True):
    """The style of C: see `Style`."""

    names: Names

    def field(self, variable: int) -> str:
        """A field of the state."""
        return f"state->{self.names.fields[variable]}"

    def label(self, variable: int, value: int) -> str:
        """An enumeration constant."""
        return self.names.values[variable][value]

    def number(self, variable: int) -> str:
        """A cast."""
        return f"(unsigned){self.field(variable)}"

    def answer(self, actions: tuple[int, ...] | None) -> Iterator[str]:
        """The words of the set, where they are not 0, and the status."""
        if actions is None:
            yield f"return {self.names.upper}_UNDECIDED;"
            return
        words: dict[int, list[int]] = {}
        for action in actions:
            words.setdefault(action // 32, []).append(action)
        for word, inside in words.items():
            mask = sum(1 << (action % 32) for action in inside)
            shown = ", ".join(self.names.actions[action] for action in inside)
            yield f"actions->words[{word}] = UINT32_C({mask:#x}); /* {shown} */"
        yield f"return {self.names.upper}_DECIDED;"

    def answer_by(self, executed: Sequence[str]) -> Iterator[str]:
        """The words of the set, a bit of each expression, and the status."""
        for word in range(self.names.words):
            roots = list(enumerate(executed))[32 * word : 32 * word + 32]
            bits = [f"((uint32_t){root} << {action % 32})" for action, root in roots if root != "false"]
            if bits:
                first, *others = bits
                yield f"actions->words[{word}] = {first}" + ("" if others else ";")
                yield from (f"    | {bit}" for bit in others[:-1])
                yield from (f"    | {bit};" for bit in others[-1:])
        yield f"return {self.names.upper}_DECIDED;"
