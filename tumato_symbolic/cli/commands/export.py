"""`tumato-sym export`: a policy in the format of another tool."""

from __future__ import annotations

from collections.abc import Iterator
from os.path import lexists
from pathlib import Path
from typing import TYPE_CHECKING

from tumato_symbolic.cli import arguments
from tumato_symbolic.cli.console import note, write, writing
from tumato_symbolic.cli.exits import YES
from tumato_symbolic.cli.options import STANDARD_OUTPUT, CommandOptions, Target, argument
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.export.targets import TARGETS
from tumato_symbolic.limits import Context

if TYPE_CHECKING:
    from tumato_symbolic.export.request import Request
    from tumato_symbolic.spec import Ordering, Restoration, Spec

ABOUT = """\
Write a policy for another tool. Nothing is proved here, `tumato-sym verify` does that: what is written decides as the
policy does, right or wrong. Each file says what is guaranteed of a proved policy, and what the code around it has to do
(docs/robot.md).

targets:
""" + "".join(f"  {name:<15} {target.purpose}\n" for name, target in TARGETS.items())

EXAMPLES = """\
examples:
  tumato-sym export python policy.json amr.tum -o amr.py
  tumato-sym export c99 policy.json amr.tum -o amr.c       # and amr.h
  tumato-sym export coq policy.json amr.tum -o amr.v
  coqc -q -R proofs/coq Tumato amr.v             # after `make -C proofs/coq`, in a checkout of tumato-symbolic
"""


class Options(CommandOptions, frozen=True):
    """What may be typed after `export`."""

    target: str = argument(metavar="TARGET", choices=tuple(TARGETS), help="for which tool, one of those above")
    policy: str = arguments.policy()
    specs: tuple[str, ...] = arguments.specs()
    output: str = arguments.output(
        Target("export", example="amr.py"),
        STANDARD_OUTPUT,
        "where to write it (default: the standard output; a new name without an ending gets that of the target; a "
        "target of several files needs a name, and writes the others beside it)",
    )
    check: bool = arguments.check("also write the program that checks what is written, beside FILE")
    timeout: float | None = arguments.timeout()
    memory: int | None = arguments.memory()
    effect_ordering: Ordering | None = arguments.effect_ordering()
    restoration: Restoration | None = arguments.restoration()

    def endings(self) -> tuple[str, ...]:
        """How the names of the files end that are written beside FILE."""
        target = TARGETS[self.target]
        return (*target.beside, *([target.check] if self.check and target.check else []))

    def paths(self) -> tuple[Path, ...]:
        """FILE, with the ending of its target where it has none and is not there yet, and those beside it."""
        from tumato_symbolic.cli.targets import is_stream

        path = Path(self.output)
        if path.is_dir():
            return (path,)
        if not (path.suffix or lexists(path) or is_stream(path)):
            path = path.with_name(path.name + Path(TARGETS[self.target].example).suffix)
        return (path, *(path.with_name(path.stem + ending) for ending in self.endings()))

    def targets(self) -> Iterator[Target]:
        """Every file that is written."""
        if self.output == STANDARD_OUTPUT:
            yield from CommandOptions.targets(self)
        else:
            yield from (Target("export", path=str(path)) for path in self.paths())

    def mistake(self) -> str | None:
        """Only some targets have a check, and only some fit into the standard output."""
        target = TARGETS[self.target]
        if self.check and target.check is None:
            having = ", ".join(name for name, each in TARGETS.items() if each.check) or "none"
            return f"--check: the target {self.target} has no such program (of all targets: {having})"
        if not self.endings():
            return None
        if self.output == STANDARD_OUTPUT:
            return f"the target {self.target} takes several files: name the first with -o, as in -o {target.example}"
        if len(set(self.paths())) < len(self.paths()):
            return f"-o {self.output}: that is the name of another of the files; take one such as {target.example}"
        if any(character in Path(self.output).name for character in '"\\\n\r'):
            return f"-o {self.output}: the files name each other, which such a name does not allow"
        return None


def run(options: Options, context: Context) -> int:
    """Exit with 0 when all is written; whether the policy is right is not asked."""
    from tumato_symbolic.cli.inputs import errors_in, read_spec, show_warnings
    from tumato_symbolic.cli.targets import is_stream
    from tumato_symbolic.export.targets import load

    if options.endings() and is_stream(Path(options.output)):
        message = f"the target {options.target} takes several files, and nothing can be written beside {options.output}"
        raise UserError((Diagnostic(Code.TUM510, message, help="name a file with -o"),))
    context.tell("reading the specification")
    source, spec, warnings = read_spec(options.specs[0], options.restoration)
    context.tell(f"reading {options.policy}")
    with errors_in(source):
        request = _request(options, spec)
        context.tell("writing the export")
        texts = load(options.target)(request)
    show_warnings(warnings, source, options)
    _write(texts, options, request.ordering)
    return YES


def _request(options: Options, spec: Spec) -> Request:
    """The policy for its specification, where it was made for no weaker meaning."""
    from tumato_symbolic.export.request import Request
    from tumato_symbolic.policy import Policy, fitted, made_for_less, restores_less

    policy = Policy.load(options.policy)
    if options.effect_ordering is None and made_for_less(policy, spec):
        raise _made_for_less(options.policy)
    if options.restoration is None and restores_less(policy, spec):
        raise _restores_less(options.policy, policy.restoration, spec.restoration)
    ordering = options.effect_ordering or spec.ordering
    name = Path(TARGETS[options.target].example if options.output == STANDARD_OUTPUT else options.output).stem
    return Request(fitted(policy, spec), spec, ordering, name, options.check)


def _write(texts: tuple[str, ...], options: Options, ordering: Ordering) -> None:
    from tumato_symbolic.diagnostics.wording import listed
    from tumato_symbolic.policy import save_text

    if options.output == STANDARD_OUTPUT:
        write(texts[0])
        return
    paths = options.paths()
    with writing():
        for path, text in zip(paths, texts, strict=True):
            save_text(text, path, "export")
    names = listed([str(path) for path in paths], plain=True)
    verb = "is" if len(paths) == 1 else "are"
    note(f"{names} {verb} written, for effects in the ordering {ordering}. {_NEXT.get(options.target, '')}".rstrip())


_NEXT = {"coq": "It is a proof when Coq compiles it."}


def _made_for_less(path: str) -> UserError:
    message = f"{path} was made for the effect ordering first, but the specification means any"
    help_ = "synthesize it again, or say with --effect-ordering which of them the export is about"
    return UserError((Diagnostic(Code.TUM511, message, help=help_),))


def _restores_less(path: str, made_for: Restoration, meant: Restoration) -> UserError:
    message = f"{path} was made for `restoration: {made_for}`, but the specification means {meant}"
    help_ = "synthesize it again, or say with --restoration which of them the export is about"
    return UserError((Diagnostic(Code.TUM511, message, help=help_),))
