"""Whether models for other tools decide as `decide` does, in every state where runs begin: the tools are asked.

`python -m tests.export.decided nusmv` asks one of the policy of every example. The decisions are written into the
model once more, from `decide` and not from the rules that are printed.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence, Set
from pathlib import Path
from types import ModuleType
from typing import Final, TypeAlias

from tests.export.model_checkers import nusmv_verdicts, spin_accepts, storm_verdicts, tla_verdicts
from tests.export.policies import EXAMPLES, decisions, example
from tumato_symbolic.export import nusmv, prism, promela, tlaplus
from tumato_symbolic.export.model import Claims
from tumato_symbolic.export.request import Request
from tumato_symbolic.semantics import State

Decided: TypeAlias = Mapping[State, tuple[str, ...] | None]


def decided(made: Request) -> dict[State, tuple[str, ...] | None]:
    """The decisions, as `decide` tells them."""
    return dict(decisions(made))


def by_nusmv(made: Request, wanted: Decided, folder: Path) -> bool:
    """Whether NuSMV finds these decisions in the model of a policy."""
    (text,) = nusmv.files(made)
    text += f"CTLSPEC NAME as_decided := {_claim(nusmv, made, wanted)}\n"
    return nusmv_verdicts([(text,)], folder)[0]["as_decided"]


def by_storm(made: Request, wanted: Decided, folder: Path) -> bool:
    """Whether Storm does."""
    text, properties = prism.files(made)
    properties += f'"as_decided": {_claim(prism, made, wanted)};\n'
    return storm_verdicts([(text, properties)], folder)[0]["as_decided"]


def by_spin(made: Request, wanted: Decided, folder: Path) -> bool:
    """Whether SPIN does, wherever a decision is taken."""
    (text,) = promela.files(made)
    claim = f"           assert({_claim(promela, made, wanted)});\n"
    first = "           assert(DECIDED);\n           assert(ALLOWED);\n"
    assert text.count(first) == 1
    return spin_accepts(text.replace(first, claim + first), folder)


def by_tla(made: Request, wanted: Decided, folder: Path) -> bool:
    """Whether `tla` does; decisions are sets of names there."""
    module, _ = tlaplus.files(made)
    names = [f"state.{name}" for name in tlaplus.model_of(made).variables]
    values = [variable.values for variable in made.spec.variables]

    def answer(prefix: State) -> str:
        if len(prefix) == len(names):
            actions = wanted[prefix]
            return "Undecided" if actions is None else tlaplus._set_of(actions)
        *parts, last = [answer((*prefix, value)) for value in range(len(values[len(prefix)]))]
        if all(part == last for part in parts):
            return last
        name, known = names[len(prefix)], values[len(prefix)]
        tests = (f'IF {name} = "{value}" THEN {part} ELSE ' for value, part in zip(known, parts, strict=False))
        return f"({''.join(tests)}{last})"

    claim = f"AsDecided == (~acting /\\ steps = 0) => decision = {answer(())}\n\n===="
    configuration = "SPECIFICATION Spec\nCHECK_DEADLOCK FALSE\nINVARIANT AsDecided\n"
    assert module.count("\n====\n") == 1
    return tla_verdicts([(module.replace("\n====\n", f"\n{claim}\n"), configuration)], folder)[0]["as_decided"]


def _claim(target: ModuleType, made: Request, wanted: Decided) -> str:
    """That each action is executed where it is wanted, and that just these states are decided."""
    model = target.model_of(made)
    claims = Claims(model, target._LANGUAGE)
    known = {state for state, actions in wanted.items() if actions is not None}
    found = [claims.same(target._LANGUAGE.decided, _where(claims, known))]
    for cases in model.loop.cases:
        name = model.loop.actions[cases[0]].name
        executed = claims.any(f"executed_{model.actions[case]}" for case in cases)
        chosen = {state for state, actions in wanted.items() if name in (actions or ())}
        found.append(claims.same(executed, _where(claims, chosen)))
    return claims.all(found)


def _where(claims: Claims, states: Set[State], prefix: State = ()) -> str:
    """Where the state is one of these, variable by variable."""
    variables = claims.model.loop.variables
    if len(prefix) == len(variables):
        return claims.language.by.constant(prefix in states)
    place = len(prefix)
    parts = [_where(claims, states, (*prefix, value)) for value in range(len(variables[place].values))]
    if all(part == parts[0] for part in parts):
        return parts[0]
    return claims.any(claims.all([claims._is(place, value), part]) for value, part in enumerate(parts))


TOOLS: Final[Mapping[str, Callable[[Request, Decided, Path], bool]]] = {
    "nusmv": by_nusmv,
    "spin": by_spin,
    "storm": by_storm,
    "tla": by_tla,
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask a tool about the policies of the examples; exit with 1 where one decides otherwise."""
    parser = argparse.ArgumentParser(prog="python -m tests.export.decided", description=__doc__)
    parser.add_argument("tool", choices=tuple(TOOLS))
    parser.add_argument("--only", action="append", help="one of the examples, any number of times")
    options = parser.parse_args(arguments)
    bad = 0
    for name in options.only or EXAMPLES:
        made, started = example(name), time.monotonic()
        wanted = decided(made)
        with tempfile.TemporaryDirectory() as folder:
            same = TOOLS[options.tool](made, wanted, Path(folder))
        bad += not same
        print(f"  {name}: {'the same' if same else 'another'} of {len(wanted):,}; {time.monotonic() - started:.0f} s")
    return 1 if bad else 0


if __name__ == "__main__":
    raise SystemExit(main())
