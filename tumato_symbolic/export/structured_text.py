"""A policy as a function block in Structured Text (IEC 61131-3), for programmable logic controllers."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from string import Template
from typing import Final

from msgspec import Struct

from tumato_symbolic.export.decisions import DecisionRule, rules_of
from tumato_symbolic.export.identifiers import distinct, identifier
from tumato_symbolic.export.request import Request, commented

_BLOCK = Template("""\
(* What to do in a state: the decisions of a policy. Written by `tumato-sym export structured-text`.

$promise *)

${types}TYPE
    $status : ($invalid, $undecided, $decided);
END_TYPE

(* Look at the status first: no action is TRUE where nothing is to be done, and where nothing is decided. It is
   $invalid where an input has a value that it cannot have, $undecided where the policy says nothing of
   the state (no action is known to be safe then), and $decided where just the actions that are TRUE are to be
   executed, together; where none is, do nothing. *)
FUNCTION_BLOCK $decide
VAR_INPUT
${inputs}END_VAR
VAR_OUTPUT
    status : $status;
${outputs}END_VAR

${clear}status := $invalid;
IF $unknown THEN
    RETURN;
END_IF;

status := $decided;
${rules}END_FUNCTION_BLOCK
""")

_WORDS: Final = """
ABSTRACT ACTION ADR AND AND_THEN ANY ARRAY AT BOOL BY BYTE CASE CLASS CONFIGURATION CONSTANT CONTINUE CTD CTU CTUD
DATE DINT DO DT DWORD ELSE ELSIF EN END ENO ERROR EXIT EXPT EXTENDS FALSE FINAL FOR FROM FUNCTION F_TRIG GE GOTO GT IF
IMPLEMENTS IN INT INTERFACE INTERNAL INTERVAL LD LDATE LDT LE LEN LIMIT LINT LREAL LT LTIME LTOD LWORD MAX METHOD MIN
MOD MOVE MUX NAMESPACE NE NON_RETAIN NOT NULL OF ON OR OR_ELSE OVERLAP OVERRIDE PERSISTENT POINTER PRIORITY PRIVATE
PROGRAM PROPERTY PROTECTED PUBLIC READ_ONLY READ_WRITE REAL REF REF_TO REFERENCE REPEAT RESOURCE RET RETAIN RETURN ROL
ROR RS R_EDGE R_TRIG SEL SHL SHR SIN SINT SQRT SR STEP STRING STRUCT SUPER TAN TASK THEN THIS TIME TO TOD TOF TON TP
TRANSITION TRUE TRUNC TYPE UDINT UINT ULINT UNION UNTIL USING USINT VAR VAR_ACCESS VAR_CONFIG VAR_EXTERNAL VAR_GLOBAL
VAR_INPUT VAR_IN_OUT VAR_OUTPUT VAR_STAT VAR_TEMP WCHAR WHILE WITH WORD WSTRING XOR ABS ACOS ASIN ATAN COS EXP LN LOG
LEFT RIGHT MID CONCAT DELETE FIND INSERT REPLACE ADD SUB MUL DIV EQ S R N P L D Q CHAR STATUS
"""
"""Words of the language and of its standard functions, in any case, and the output that is ours."""


_OURS: Final = ("status", "invalid", "undecided", "decided", "decide")
"""What the block, the type of its status, and its constants are called, after the name of the file."""


class Names(Struct, frozen=True):
    """Identifiers, of which no two differ in case alone; types and values begin with the name of the file."""

    prefix: str
    types: tuple[str, ...]
    inputs: tuple[str, ...]
    values: tuple[tuple[str, ...], ...]
    outputs: tuple[str, ...]

    @classmethod
    def of(cls, request: Request) -> Names:
        """The names for a policy."""
        vocabulary, prefix = request.policy.vocabulary, _spelled(request.name)
        reserved = {*_WORDS.split(), *(f"{prefix}_{each}".upper() for each in _OURS)}
        wanted: dict[tuple[str, ...], str] = {}
        for name, values in vocabulary.variables:
            wanted["type", name] = f"{prefix}_{_spelled(name)}_type"
            wanted["input", name] = _free(_spelled(name), reserved)
            for value in values:
                wanted["value", name, value] = f"{prefix}_{_spelled(f'{name}_{value}')}"
        for action in vocabulary.actions:
            wanted["output", action] = _free(_spelled(action), reserved)
        found = distinct(wanted, case_matters=False)
        return cls(
            prefix,
            tuple(found["type", name] for name, _ in vocabulary.variables),
            tuple(found["input", name] for name, _ in vocabulary.variables),
            tuple(tuple(found["value", name, value] for value in values) for name, values in vocabulary.variables),
            tuple(found["output", action] for action in vocabulary.actions),
        )


def _spelled(text: str) -> str:
    """An identifier that neither ends with `_` nor has two of them in a row, as the standard wants it."""
    return re.sub("_+", "_", identifier(text)).strip("_") or "x"


def _free(name: str, reserved: Collection[str]) -> str:
    return f"x_{name}" if name.upper() in reserved else name


def files(request: Request) -> tuple[str]:
    """The text of the block. Raises `UserError` (TUM508) where the policy has no short list of rules."""
    names = Names.of(request)
    types = zip(names.types, names.values, strict=True)
    text = _BLOCK.substitute(
        promise=commented(request.promise, "   "),
        types="".join(f"TYPE\n    {type_} : ({', '.join(values)});\nEND_TYPE\n\n" for type_, values in types),
        **{each: f"{names.prefix}_{each}" for each in _OURS},
        inputs="".join(f"    {name} : {type_};\n" for name, type_ in zip(names.inputs, names.types, strict=True)),
        outputs="".join(f"    {name} : BOOL;\n" for name in names.outputs),
        clear="".join(f"{name} := FALSE;\n" for name in names.outputs),
        unknown="\n    OR ".join(
            f"NOT {_is_one(name, values)}" for name, values in zip(names.inputs, names.values, strict=True)
        ),
        rules="".join(_rules(request, names)),
    )
    return (text,)


def _is_one(name: str, values: tuple[str, ...]) -> str:
    return f"({' OR '.join(f'{name} = {value}' for value in values)})"


def _rules(request: Request, names: Names) -> Iterator[str]:
    """The rules in their order; the last matches always."""
    rules = rules_of(request.policy)
    vocabulary = request.policy.vocabulary
    places = {name: number for number, (name, _) in enumerate(vocabulary.variables)}
    outputs = dict(zip(vocabulary.actions, names.outputs, strict=True))

    def condition(rule: DecisionRule) -> Iterator[str]:
        for name, values in rule.condition:
            place = places[name]
            known = vocabulary.variables[place][1]
            yield _is_one(names.inputs[place], tuple(names.values[place][known.index(value)] for value in values))

    for number, rule in enumerate(rules):
        if rule.condition:
            yield f"{'ELSIF' if number else 'IF'} {' AND '.join(condition(rule))} THEN\n"
        elif number:
            yield "ELSE\n"
        margin = "    " if len(rules) > 1 else ""
        if rule.actions is None:
            yield f"{margin}status := {names.prefix}_undecided;\n"
        elif not rule.actions:
            yield f"{margin}; (* nothing is to be done *)\n"
        else:
            yield from (f"{margin}{outputs[action]} := TRUE;\n" for action in rule.actions)
    if len(rules) > 1:
        yield "END_IF;\n"
