"""Workers of a Dask cluster: how long they are waited for, and how large a batch is.

The only module that knows `distributed`. What is sent there are batches as texts; what comes back are texts. A worker
solves them in child processes, as this machine would, so that one that takes all memory does not take the worker with
it.
"""

from __future__ import annotations

import logging
import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any, NoReturn

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.limits.packages import need_distributed
from tumato_symbolic.sweep.asking import ask, start
from tumato_symbolic.sweep.portions import LostError, Workers

_PATIENCE = 5.0
"""Seconds in which the scheduler has to answer, and to have workers."""

_SECONDS = 1.0
"""How long a batch should take: handing it over costs some hundredths of a second."""


@contextmanager
def cluster(address: str) -> Iterator[Workers]:
    """The workers of the scheduler at an address.

    Raises `UserError` (TUM119) where it cannot be reached, has no workers, or one of them has other versions than this
    machine; `MissingPackageError` where `distributed` is not there.
    """
    need_distributed("hand work to a cluster")
    from distributed import Client

    logger = logging.getLogger("distributed")  # what it would say of lost connections is said below
    logger.handlers, logger.propagate = [logging.NullHandler()], False
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        _reach(address)
        client = Client(address, timeout=_PATIENCE, set_as_default=False)
        try:
            threads = _threads(client, address)
            _compare(client.run(_versions(), on_error="return"), address)
            client.run(_start)
            yield Workers(partial(_submitted, client, address), threads, _SECONDS)
        finally:
            with suppress(Exception):  # the scheduler may have gone
                client.close(timeout=1)


def _reach(address: str) -> None:
    """Raise `UserError` where no scheduler answers at an address.

    A client that finds none is left half made, and may lock up what begins while it is taken away.
    """
    import asyncio

    from distributed.comm import connect
    from distributed.security import Security

    async def answered() -> None:
        comm = await connect(address, timeout=_PATIENCE, **Security().get_connection_args("client"))
        await comm.close()

    try:
        asyncio.run(answered())
    except (OSError, ValueError, TypeError, ImportError) as error:
        reason = str(error).split("\n")[0]
        unreachable = isinstance(error, OSError)
        help_ = "start one with `dask scheduler`, and workers with `dask worker ADDRESS`" if unreachable else _ADDRESS
        said = f"there is no answer within {_PATIENCE:g} s" if unreachable else reason
        _fail(f"the scheduler at {quoted(address)} cannot be reached: {said}", help_)


_ADDRESS = "an address is HOST:PORT, such as 127.0.0.1:8786, or tls://HOST:PORT"


def _threads(client: Any, address: str) -> int:  # noqa: ANN401
    """How many threads work there."""
    until = time.monotonic() + _PATIENCE
    while not (threads := sum(map(int, client.nthreads().values()))):
        if time.monotonic() > until:
            _fail(f"the scheduler at {quoted(address)} has no workers", "start one with `dask worker ADDRESS`")
        time.sleep(0.1)
    return threads


def _compare(found: Mapping[str, object], address: str) -> None:
    """Raise `UserError` where a worker has another version of something, or nothing."""
    here = _versions()()
    for worker, there in found.items():
        if not isinstance(there, dict):
            _fail(f"the worker {worker} of {quoted(address)} cannot be asked for versions: {there}", "start it anew")
        for package, mine in here.items():
            if there[package] != mine:
                theirs = f"has {package} {there[package]}" if there[package] else f"does not have {package}"
                message = f"the worker {worker} of {quoted(address)} {theirs}, and {package} here is {mine}"
                _fail(message, "answers may depend on it: install the same version everywhere")


def _versions() -> Callable[[], dict[str, str | None]]:
    """A function that tells the versions of what answers depend on; it runs where there is nothing of ours."""

    def versions() -> dict[str, str | None]:
        from importlib.metadata import PackageNotFoundError, version

        found: dict[str, str | None] = {"tumato-symbolic": None}
        try:
            import tumato_symbolic

            found["tumato-symbolic"] = tumato_symbolic.__version__
        except ImportError:
            pass
        for name in ("dd", "z3-solver"):
            try:
                found[name] = version(name)
            except PackageNotFoundError:
                found[name] = None
        return found

    return versions


def _start(dask_worker: Any) -> None:  # noqa: ANN401
    """Have children start on a worker, one for each of its threads."""
    start(dask_worker.state.nthreads)


def _submitted(client: Any, address: str, batch: str) -> Future[str]:  # noqa: ANN401
    """A batch handed over."""
    reply: Future[str] = Future()
    reply.set_running_or_notify_cancel()
    client.submit(ask, batch, pure=False).add_done_callback(partial(_done, reply, address))
    return reply


def _done(reply: Future[str], address: str, there: Any) -> None:  # noqa: ANN401 - a future of Dask
    """Take what a worker replied."""
    from distributed import KilledWorker

    try:
        reply.set_result(there.result(timeout=_PATIENCE))
    except KilledWorker:
        reply.set_exception(LostError("the workers that solved it were killed one after the other"))
    except (CancelledError, OSError, TimeoutError):
        reply.set_exception(_failure(f"the connection to the scheduler at {quoted(address)} was lost", _GO_ON))
    except Exception as error:  # noqa: BLE001 - whatever a worker raises
        reply.set_exception(error)


_GO_ON = "with -o FILE, the same command goes on where this one stopped"


def _fail(message: str, help_: str) -> NoReturn:
    raise _failure(message, help_)


def _failure(message: str, help_: str) -> UserError:
    return UserError((Diagnostic(Code.TUM119, message, help=help_),))
