"""A policy as a header and a source in C99: no memory is allocated, and nothing else is needed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from string import Template
from textwrap import indent

from tumato_symbolic.diagrams import Reference
from tumato_symbolic.export.c99_check import check
from tumato_symbolic.export.c99_names import Names
from tumato_symbolic.export.decisions import MOST_QUESTIONS, Answer, Question, Tree, size_written_out, tree_of
from tumato_symbolic.export.request import Request, commented
from tumato_symbolic.policy import Policy, as_diagram

MOST_ANSWERS = 1_000
"""Trees with more answers are not written as nested `switch`: each action is a Boolean function instead."""

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
    ${u}_UNDECIDED, /* the policy says nothing of this state, which the specification excludes */
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
        decide="".join(_decide(request.policy, names)),
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


def _decide(policy: Policy, names: Names) -> Iterator[str]:
    tree = tree_of(policy, MOST_QUESTIONS)
    if tree is None or size_written_out(tree) > MOST_ANSWERS:
        return _by_functions(policy, names)
    return _by_switch(tree, names, "    ")


def _by_switch(tree: Tree, names: Names, margin: str) -> Iterator[str]:
    """Statements that end by returning the status."""
    if isinstance(tree, Answer):
        yield from _answer(tree, names, margin)
        return
    yield f"{margin}switch (state->{names.fields[tree.variable]}) {{\n"
    groups = _largest_last(tree)
    for place, (values, below) in enumerate(groups, 1):
        yield from (f"{margin}case {names.values[tree.variable][value]}:\n" for value in values)
        if place == len(groups):
            yield f"{margin}default:\n"
        yield from _by_switch(below, names, f"{margin}    ")
    yield f"{margin}}}\n"


def _largest_last(question: Question) -> list[tuple[tuple[int, ...], Tree]]:
    groups = question.groups()
    largest = max(reversed(groups), key=lambda group: len(group[0]))
    return [*(group for group in groups if group is not largest), largest]


def _answer(answer: Answer, names: Names, margin: str) -> Iterator[str]:
    if answer.actions is None:
        yield f"{margin}return {names.upper}_UNDECIDED;\n"
        return
    words: dict[int, list[int]] = {}
    for action in answer.actions:
        words.setdefault(action // 32, []).append(action)
    for word, actions in words.items():
        mask = sum(1 << (action % 32) for action in actions)
        shown = ", ".join(names.actions[action] for action in actions)
        yield f"{margin}actions->words[{word}] = UINT32_C({mask:#x}); /* {shown} */\n"
    yield f"{margin}return {names.upper}_DECIDED;\n"


def _by_functions(policy: Policy, names: Names) -> Iterator[str]:
    """A Boolean for every node of the diagrams, those below before those above, without a branch or a loop."""
    decisions = as_diagram(policy)
    diagram, base = decisions.diagram, len(decisions.diagram.leaves)

    def shown(reference: Reference) -> str:
        return ("true" if diagram.leaves[reference] else "false") if reference < base else f"n{reference - base}"

    for variable in sorted({diagram.order[level] for level, _ in diagram.nodes}):
        yield f"    const unsigned v{variable} = (unsigned)state->{names.fields[variable]};\n"
    for number, (level, below) in enumerate(diagram.nodes):
        yield f"    const bool n{number} = {_choice(f'v{diagram.order[level]}', [shown(each) for each in below])};\n"
    yield f"    if (!{shown(decisions.defined)}) {{\n        return {names.upper}_UNDECIDED;\n    }}\n"
    for word in range(names.words):
        roots = list(enumerate(decisions.roots))[32 * word : 32 * word + 32]
        bits = [f"((uint32_t){shown(root)} << {action % 32})" for action, root in roots if shown(root) != "false"]
        if bits:
            yield f"    actions->words[{word}] = " + "\n        | ".join(bits) + ";\n"
    yield f"    return {names.upper}_DECIDED;\n"


def _choice(value: str, below: Sequence[str]) -> str:
    """What follows from each value; the most frequent is for all that are not named."""
    rest = max(dict.fromkeys(below), key=below.count)
    text = rest
    for each in dict.fromkeys(below):
        if each != rest:
            tests = " || ".join(f"{value} == {number}u" for number, found in enumerate(below) if found == each)
            text = f"({tests}) ? {each} : {text}"
    return text
