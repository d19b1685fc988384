"""One door to dd: sets of bit vectors as binary decision diagrams, on CUDD or on dd's pure Python backend.

The order of the bits is fixed before the first operation and never changes, and nothing here depends on how a backend
enumerates, so that both backends give the same results.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType
from typing import Any, Literal, Protocol, TypeAlias

from tumato_symbolic.diagrams import conjoin, room_for
from tumato_symbolic.limits import Context, LimitReachedError, MissingPackageError

Backend: TypeAlias = Literal["cudd", "autoref"]

_FEW_BITS, _MANY_BITS = 10, 18
"""With as many bits or more, CUDD expects what it does by itself: a cache of 2^18 results, and a gigabyte."""


class Bdd(Protocol):
    """A set, or the predicate that is true in it. Equality is equality of sets."""

    def __and__(self, other: Bdd, /) -> Bdd:
        """Intersection."""

    def __or__(self, other: Bdd, /) -> Bdd:
        """Union."""

    def __invert__(self) -> Bdd:
        """Complement."""


class TooManyNodesError(Exception):
    """A diagram has more nodes than `Manager.at_most` allows."""


class _Later(ModuleType):
    """Stands for a module until one of its functions or classes is called."""

    def __getattr__(self, name: str) -> Callable[..., object]:
        if name.startswith("__"):
            raise AttributeError(name)

        def call(*values: object, **named: object) -> object:
            return getattr(import_module(self.__name__), name)(*values, **named)

        return call


def _import_dd(backend: Backend) -> ModuleType:
    """A backend of dd, without networkx, which dd wants for drawings only and which is half of its start-up."""
    wanted = "networkx"
    if f"dd.{backend}" in sys.modules or wanted in sys.modules:
        return import_module(f"dd.{backend}")
    sys.modules[wanted] = _Later(wanted)
    try:
        return import_module(f"dd.{backend}")
    finally:
        del sys.modules[wanted]


def available_backend() -> Backend:
    """CUDD where dd was built with it, else the pure Python backend. Raises `MissingPackageError` without dd."""
    backends: tuple[Backend, ...] = ("cudd", "autoref")
    for backend in backends:
        try:
            _import_dd(backend)
        except ImportError:
            continue
        return backend
    raise MissingPackageError("dd", "dd", "look for policies")


def _raised_by_cudd(error: Exception) -> bool:
    """Whether an error comes from dd's CUDD module, which reports refused memory in many words."""
    place = error.__traceback__
    while place is not None and place.tb_next is not None:
        place = place.tb_next
    return place is not None and place.tb_frame.f_code.co_filename.endswith("cudd.pyx")


def _settings(backend: Backend, bits: int) -> Mapping[str, int]:
    """How large a problem CUDD is told to expect; whatever it is told, its cache and its tables grow by themselves.

    What it expects by itself takes longer to set up than most problems of a few bits take to solve.
    """
    scale = min(max(bits, _FEW_BITS), _MANY_BITS)
    return {"initial_cache_size": 2**scale, "memory_estimate": 2 ** (scale + 12)} if backend == "cudd" else {}


class Manager:
    """Bits in a fixed order and the operations on sets of bit vectors.

    Operations raise `LimitReachedError` when time is up; `within_memory` says so when memory is.
    """

    def __init__(self, bits: Sequence[str], backend: Backend, context: Context | None = None) -> None:
        self.backend = backend
        self.context = context or Context()
        self._most: int | None = None
        self._module: Any = _import_dd(backend)
        self._bdd: Any = self._module.BDD(**_settings(backend, len(bits)))
        self._bdd.configure(reordering=False)
        megabytes = self.context.limits.megabytes
        if megabytes is not None and backend == "cudd":
            self._bdd.configure(max_memory=megabytes * 2**20)
        self._bdd.declare(*bits)
        self.bits = tuple(bits)
        self._level = {bit: level for level, bit in enumerate(bits)}
        self._together: dict[tuple[str, ...], Bdd] = {}
        self.true: Bdd = self._bdd.true
        self.false: Bdd = self._bdd.false

    @contextmanager
    def within_memory(self) -> Iterator[None]:
        """Raise `LimitReachedError` where CUDD refuses an operation because it would need too much memory.

        Inside is room to recurse from bit to bit, as dd does in Python, and what takes sets apart.
        """
        try:
            with room_for(len(self.bits)):
                yield
        except (ValueError, RuntimeError) as error:
            if self.context.limits.megabytes is not None and _raised_by_cudd(error):
                raise LimitReachedError(self.context.described("memory")) from error
            raise

    @contextmanager
    def at_most(self, nodes: int) -> Iterator[None]:
        """Have `bounded` raise `TooManyNodesError` for larger diagrams; the same ones on every backend."""
        self._most = nodes
        try:
            yield
        finally:
            self._most = None

    def bounded(self, u: Bdd) -> Bdd:
        """`u`, if it has no more nodes than are allowed."""
        if self._most is not None and self.nodes(u) > self._most:
            raise TooManyNodesError
        return u

    def cube(self, values: Mapping[str, bool]) -> Bdd:
        """The vectors in which the given bits have the given values."""
        cube: Bdd = self._bdd.cube(dict(values))
        return cube

    def cofactor(self, u: Bdd, values: Mapping[str, bool]) -> Bdd:
        """`u` with constants substituted for bits."""
        if not values:
            return u
        result: Bdd = self._bdd.let(dict(values), u)
        return result

    def compose(self, u: Bdd, functions: Mapping[str, Bdd]) -> Bdd:
        """`u` with functions substituted for bits, all at once."""
        if not functions:
            return u
        self.context.check()
        result: Bdd = self._bdd.let(dict(functions), u)
        return result

    def exists(self, bits: Iterable[str], u: Bdd) -> Bdd:
        """`∃ bits. u`."""
        self.context.check()
        names = tuple(bits)
        if names not in self._together:
            self._together[names] = self.cube(dict.fromkeys(names, True))
        result: Bdd = self._bdd.apply("exists", self._together[names], u)
        return result

    def and_exists(self, bits: Iterable[str], u: Bdd, v: Bdd) -> Bdd:
        """`∃ bits. u ∧ v`, in one pass where the backend can."""
        self.context.check()
        if self.backend == "cudd":
            result: Bdd = self._module.and_exists(u, v, list(bits))
            return result
        return self.exists(bits, u & v)

    def union(self, parts: Iterable[Bdd]) -> Bdd:
        """The union of any number of sets."""
        result = self.false
        for part in parts:
            self.context.check()
            result = result | part
        return result

    def balanced_union(self, parts: Iterable[Bdd]) -> Bdd:
        """`union`, two by two: for sets that grow when they are united, and that have about the same size."""
        left = list(parts) or [self.false]
        while len(left) > 1:
            self.context.check()
            left = [self.union(left[number : number + 2]) for number in range(0, len(left), 2)]
        return left[0]

    def intersection(self, parts: Iterable[Bdd]) -> Bdd:
        """The intersection of any number of sets."""
        return conjoin(parts, self._levels_of, self._both, self.true)

    def _both(self, u: Bdd, v: Bdd) -> Bdd:
        self.context.check()
        return self.bounded(u & v)

    def _levels_of(self, u: Any) -> list[int]:  # noqa: ANN401 - dd has no types
        return sorted(map(self._level.__getitem__, self._bdd.support(u)))

    def nodes(self, u: Any) -> int:  # noqa: ANN401 - dd has no types
        """How many nodes the diagram of `u` has."""
        count: int = u.dag_size
        return count

    def support(self, u: Any) -> frozenset[str]:  # noqa: ANN401 - dd has no types
        """The bits on which `u` depends."""
        return frozenset(self._bdd.support(u))

    def level(self, bit: str) -> int:
        """Where a bit stands in the order; 0 is the top."""
        return self._level[bit]

    def top(self, u: Any) -> int:  # noqa: ANN401 - dd has no types
        """The level of the first bit on which `u` depends; larger than every level, where it depends on none."""
        level: int = u.level
        return level

    def branches(self, u: Any) -> tuple[int, Bdd, Bdd]:  # noqa: ANN401 - dd has no types
        """`(level, low, high)` of a set that is neither empty nor everything."""
        low, high = u.low, u.high
        return (u.level, ~low, ~high) if u.negated else (u.level, low, high)

    def some(self, u: Bdd, bits: Sequence[str]) -> dict[str, bool]:
        """The values of bits in a vector of a set that is not empty."""
        found: dict[int, bool] = {}
        while u != self.true:
            level, low, high = self.branches(u)
            found[level] = low == self.false
            u = high if found[level] else low
        return {bit: found.get(self._level[bit], False) for bit in bits}

    def halves(self, u: Bdd, level: int) -> tuple[Bdd, Bdd]:
        """`u` without and with the bit at a level, above which it depends on none."""
        return self.branches(u)[1:] if self.top(u) == level else (u, u)

    def descending(self, u: Bdd) -> list[tuple[Bdd, int, Bdd, Bdd]]:
        """Every inner node `(node, level, low, high)` below `u`, each once, children before parents."""
        done: set[Bdd] = {self.true, self.false}
        found: list[tuple[Bdd, int, Bdd, Bdd]] = []
        stack: list[tuple[Bdd, tuple[int, Bdd, Bdd] | None]] = [(u, None)]
        while stack:
            node, parts = stack.pop()
            if parts is not None:
                found.append((node, *parts))
            elif node not in done:
                done.add(node)
                parts = self.branches(node)
                stack += [(node, parts), (parts[1], None), (parts[2], None)]
        return found

    def count(self, u: Bdd, bits: Sequence[str]) -> int:
        """The exact number of vectors over `bits` in `u`, which depends on no other bit."""
        rank = {self._level[bit]: position for position, bit in enumerate(sorted(bits, key=self._level.__getitem__))}
        size = len(bits)
        below: dict[Bdd, tuple[int, int]] = {self.false: (0, size), self.true: (1, size)}
        for node, level, low, high in self.descending(u):
            here = rank[level]
            total = sum(below[part][0] << (below[part][1] - here - 1) for part in (low, high))
            below[node] = (total, here)
        total, top = below[u]
        return total << top
