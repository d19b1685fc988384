"""Workers of a Dask cluster: how long they are waited for, and how large a batch is.

The only module that knows `distributed`. What is sent there are batches as texts; what comes back are texts. A worker
solves them in child processes, as this machine would, so that one that takes all memory does not take the worker with
it.
"""

from __future__ import annotations

import asyncio
import logging
import time
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager, suppress
from typing import Any, NoReturn, TypeAlias

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.limits.packages import need
from tumato_symbolic.sweep.asking import start
from tumato_symbolic.sweep.portions import LostError, Workers
from tumato_symbolic.sweep.versions import Versions, difference, versions

_PATIENCE = 5.0
"""Seconds in which the scheduler has to answer, and to have workers that answer, before any work."""

_SILENCE = 30.0
"""Seconds in which the scheduler, or a worker, has to give a sign of life later: a worker may be started anew."""

_LOOK = 1.0
"""Seconds between two looks at the workers."""

_SECONDS = 1.0
"""How long a batch should take: handing it over costs some hundredths of a second."""

_Reply: TypeAlias = tuple[str, Versions, str | OSError | None]
"""A worker, its versions, and the reply to a batch; None where these are other versions than here.

An error where the system lets it start no process: raised there, it would look like one of the connection.
"""


class _Sign(Struct, frozen=True):
    """A sign of life of a worker: its threads, when it was `sent`, by other clocks, and when it was `noticed` here."""

    threads: int
    sent: float
    noticed: float


@contextmanager
def cluster(address: str) -> Iterator[Workers]:
    """The workers of the scheduler at an address, those that join later too.

    Raises `UserError` (TUM119) where it cannot be reached, has no workers, or one of them does not answer or has other
    versions than this machine; `MissingPackageError` where `distributed` is not there.
    """
    need("distributed", "cluster", "hand work to a cluster")
    from distributed import Client

    for name in ("distributed", "distributed.client"):  # what they would say of lost connections is said below
        logger = logging.getLogger(name)
        logger.handlers, logger.propagate = [logging.NullHandler()], False
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        _reach(address)
        client = Client(address, timeout=_PATIENCE, set_as_default=False)
        try:
            found = _Cluster(client, address)
            found.wait_for_workers()
            for worker, there in found.run(versions()).items():
                _compare(worker, there, address)
            found.run(_start)
            yield Workers(found.submit, found.hands, _SECONDS)
        finally:
            with suppress(Exception):  # the scheduler may have gone
                client.close(timeout=1)


def _reach(address: str) -> None:
    """Raise `UserError` where no scheduler answers at an address.

    A client that finds none is left half made, and may lock up what begins while it is taken away.
    """
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


class _Cluster:
    """A scheduler, and what is known of its workers.

    The scheduler itself gives up a worker that hangs after five to ten minutes, which is long for a sweep.
    """

    def __init__(self, client: Any, address: str) -> None:  # noqa: ANN401
        self._client, self._address = client, address
        self._ask = _asking(versions(), versions()())
        self._signs: dict[str, _Sign] = {}
        self._looked = self._heard = time.monotonic()
        self._under_way: dict[str, asyncio.Future[_Reply]] = {}
        self._taken_away: set[str] = set()

    def wait_for_workers(self) -> None:
        """Raise `UserError` where there are none within a while."""
        until = time.monotonic() + _PATIENCE
        self._look()
        while not self._signs:
            if time.monotonic() > until:
                self._fail("has no workers", _START)
            time.sleep(0.1)
            self._look()

    def run(self, function: Callable[..., object]) -> dict[str, object]:
        """What a function returns on each worker; an exception where it raises one, or there is no answer."""

        async def one(worker: str) -> object:
            try:
                return (await asyncio.wait_for(self._client.run(function, workers=[worker]), _PATIENCE))[worker]
            except TimeoutError:
                return TimeoutError(f"there is no answer within {_PATIENCE:g} s")
            except Exception as error:  # noqa: BLE001 - whatever happens on a worker
                return error

        async def each() -> list[object]:
            return await asyncio.gather(*map(one, self._signs))

        return dict(zip(self._signs, self._client.sync(each), strict=True))

    def hands(self) -> int:
        """How many threads work there. Raises `UserError` where nobody has for a while, or the scheduler is gone."""
        if time.monotonic() - self._looked > _LOOK:
            self._look()
            silent = self._silent()
            if silent and silent == set(self._signs):
                self._fail(f"has no worker that has answered within {_SILENCE:g} s", f"start them anew; {_GO_ON}")
            if time.monotonic() - self._heard > _SILENCE:
                self._fail("has no workers any more", f"{_START}; {_GO_ON}")
            if silent:
                self._sync(lambda: self._take_away(silent))
        silent = self._silent()
        return max(1, sum(each.threads for name, each in self._signs.items() if name not in silent))

    def submit(self, batch: str) -> Future[str]:
        """Hand over a batch."""
        return asyncio.run_coroutine_threadsafe(self._reply(batch), self._client.loop.asyncio_loop)

    async def _reply(self, batch: str) -> str:
        """The reply to a batch, which is handed over again where it is taken away from a worker."""
        while (found := await self._attempt(batch)) is None:
            pass
        worker, there, reply = found
        if reply is None:
            _compare(worker, there, self._address)
        if isinstance(reply, OSError):
            _fail(f"the worker {worker} of {quoted(self._address)} cannot solve anything: {reply}", _GO_ON)
        return str(reply)

    async def _attempt(self, batch: str) -> _Reply | None:
        from distributed import KilledWorker

        silent = self._silent()
        others = [name for name in self._signs if name not in silent] if silent else None
        there = self._client.submit(self._ask, batch, pure=False, workers=others, allow_other_workers=bool(others))
        self._under_way[there.key] = asyncio.ensure_future(there.result())
        try:
            return await self._under_way[there.key]
        except KilledWorker:
            raise LostError("the workers that solved it were killed one after the other") from None
        except (CancelledError, asyncio.CancelledError, OSError):
            if there.key in self._taken_away:
                return None
            raise _lost(self._address) from None
        finally:
            del self._under_way[there.key]

    async def _take_away(self, silent: set[str]) -> None:
        """What workers have, which are silent, is handed over to others."""
        for held in (await self._client.processing(), await self._client.has_what()):
            for key in (key for worker in silent for key in held.get(worker, ()) if key in self._under_way):
                self._taken_away.add(key)
                self._under_way[key].cancel()

    def _silent(self) -> set[str]:
        """The workers that have given no sign of life for a while."""
        return {name for name, each in self._signs.items() if self._looked - each.noticed > _SILENCE}

    def _look(self) -> None:
        """Ask the scheduler which workers there are, and which of them have given a sign of life since."""
        found = self._sync(self._client.scheduler.identity)["workers"]
        self._looked, known = time.monotonic(), self._signs
        fresh = {name: _Sign(each["nthreads"], each["last_seen"], self._looked) for name, each in found.items()}
        self._signs = {
            name: known[name] if name in known and known[name].sent == each.sent else each
            for name, each in fresh.items()
        }
        if self._signs:
            self._heard = self._looked

    def _sync(self, asked: Callable[[], Any]) -> Any:  # noqa: ANN401
        """What the scheduler answers."""
        try:
            return self._client.sync(asked, callback_timeout=_SILENCE)
        except TimeoutError:
            self._fail(f"has not answered within {_SILENCE:g} s", _GO_ON)
        except (CancelledError, OSError, RuntimeError):
            raise _lost(self._address) from None

    def _fail(self, what: str, help_: str) -> NoReturn:
        _fail(f"the scheduler at {quoted(self._address)} {what}", help_)


def _compare(worker: str, there: object, address: str) -> None:
    """Raise `UserError` where a worker has another version of something, or nothing."""
    if not isinstance(there, dict):
        _fail(f"the worker {worker} of {quoted(address)} cannot be asked for versions: {there}", "start it anew")
    other = difference(there, versions()())
    if other is not None:
        help_ = "answers may depend on it: install the same version everywhere"
        _fail(f"the worker {worker} of {quoted(address)} {other}", help_)


def _start(dask_worker: Any) -> None:  # noqa: ANN401
    """Have children start on a worker, one for each of its threads."""
    start(dask_worker.state.nthreads)


def _asking(told: Callable[[], Versions], here: Versions) -> Callable[[str], _Reply]:
    """A function that solves a batch on a worker, unless that has other versions than this machine.

    It runs where there may be nothing of ours.
    """

    def asked(batch: str) -> _Reply:
        from distributed import get_worker

        worker, found = get_worker(), told()
        if found != here:
            return worker.address, found, None
        from tumato_symbolic.sweep.asking import ask

        key = worker.get_current_task()

        def wanted() -> bool:
            """Whether the task has not been cancelled, as all are when their client has gone."""
            task = worker.state.tasks.get(key)
            return task is not None and task.state != "cancelled"

        try:
            return worker.address, found, ask(batch, wanted)
        except OSError as error:
            return worker.address, found, error

    return asked


_START = "start one with `dask worker ADDRESS`"

_GO_ON = "with -o FILE, the same command goes on where this one stopped"


def _lost(address: str) -> UserError:
    return _failure(f"the connection to the scheduler at {quoted(address)} was lost", _GO_ON)


def _fail(message: str, help_: str) -> NoReturn:
    raise _failure(message, help_)


def _failure(message: str, help_: str) -> UserError:
    return UserError((Diagnostic(Code.TUM119, message, help=help_),))
