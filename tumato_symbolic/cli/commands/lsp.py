"""`tumato-sym lsp`: the language server that editors start."""

from __future__ import annotations

import os
import signal
import sys
from typing import ClassVar, NoReturn

from tumato_symbolic.cli.console import note
from tumato_symbolic.cli.exits import INTERRUPTED, UNDECIDED, YES
from tumato_symbolic.cli.numbers import seconds
from tumato_symbolic.cli.options import CommandOptions, argument
from tumato_symbolic.limits import Context

ABOUT = """\
Serve an editor: mistakes as one types, what a name stands for, completion, renaming, layout, and synthesis of what is
saved. It speaks the language server protocol on the standard streams; docs/editors.md says how editors are told of it.
"""

EXAMPLES = """\
example:
  tumato-sym lsp --synthesis 5     # editors start it; synthesis may take five seconds
"""

_SECONDS = 20.0
"""How long synthesis on saving may take, repairs included, unless another limit is given."""


class Options(CommandOptions, frozen=True):
    """What may be typed after `lsp`."""

    synthesis: float = argument(
        "--synthesis",
        type=seconds,
        metavar="SECONDS",
        default=_SECONDS,
        help=f"how long synthesis of a specification that is saved may take, repairs included (default: {_SECONDS:g})",
    )
    synthesize: bool = argument("--no-synthesis", action="store_false", help="do not synthesize what is saved")

    may_take_long: ClassVar[bool] = False


def run(options: Options, context: Context) -> int:
    """Serve until the editor says that it is enough."""
    from tumato_symbolic.limits.packages import MissingPackageError, need

    try:
        need("pygls.lsp.server", "lsp", "serve an editor")
    except MissingPackageError as error:
        note(f"tumato-sym: {error}")
        return UNDECIDED
    from tumato_symbolic.lsp.server import make_server

    context.enter("serving an editor")
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _leave)
    with os.fdopen(os.dup(sys.stdin.fileno()), "rb") as asked, os.fdopen(os.dup(sys.stdout.fileno()), "wb") as told:
        make_server(options.synthesis if options.synthesize else 0.0).start_io(asked, told)  # which closes them
    return YES


def _leave(*_: object) -> NoReturn:
    """Ctrl-C: a thread that waits for the editor cannot be woken, so that nothing but the end of all ends it."""
    note("tumato-sym: interrupted")
    os._exit(INTERRUPTED)
