"""What variables, values and actions are called in C, and which words are no names there."""

from __future__ import annotations

from typing import Final

from msgspec import Struct

from tumato_symbolic.export.identifiers import distinct, identifier
from tumato_symbolic.export.request import Request

WORDS: Final = """
auto break case char const continue default do double else enum extern float for goto if inline int long register
restrict return short signed sizeof static struct switch typedef union unsigned void volatile while
alignas alignof and and_eq asm atomic_cancel atomic_commit atomic_noexcept bitand bitor bool catch char8_t char16_t
char32_t class co_await co_return co_yield compl concept consteval constexpr constinit const_cast decltype delete
dynamic_cast explicit export false friend module mutable namespace new noexcept not not_eq nullptr operator or or_eq
override final private protected public reflexpr reinterpret_cast requires static_assert static_cast synchronized
template this thread_local throw true try typeid typename typeof typeof_unqual using virtual wchar_t xor xor_eq
complex imaginary noreturn assert errno stdin stdout stderr main NULL EOF NAN INFINITY HUGE_VAL CHAR_BIT RAND_MAX
I BUFSIZ linux unix i386 arm mips sparc sun vax near far huge interface min max signals slots emit foreach
INT8_MIN INT16_MIN INT32_MIN INT64_MIN INT8_MAX INT16_MAX INT32_MAX INT64_MAX UINT8_MAX UINT16_MAX UINT32_MAX
UINT64_MAX INTPTR_MIN INTPTR_MAX UINTPTR_MAX INTMAX_MIN INTMAX_MAX UINTMAX_MAX PTRDIFF_MIN PTRDIFF_MAX SIZE_MAX
SIG_ATOMIC_MIN SIG_ATOMIC_MAX WCHAR_MIN WCHAR_MAX WINT_MIN WINT_MAX INT_MIN INT_MAX UINT_MAX LONG_MIN LONG_MAX
ULONG_MAX CHAR_MIN CHAR_MAX SCHAR_MIN SCHAR_MAX UCHAR_MAX SHRT_MIN SHRT_MAX USHRT_MAX FILE TRUE FALSE
"""
"""Keywords of C and C++, and macros that common headers and compilers define."""


class Names(Struct, frozen=True):
    """The identifiers of a header: types and fields of variables, their values, and actions.

    Everything at the level of the file begins with `prefix` or, where it is a constant, with `upper`.
    """

    prefix: str
    upper: str
    types: tuple[str, ...]
    fields: tuple[str, ...]
    values: tuple[tuple[str, ...], ...]
    actions: tuple[str, ...]

    @property
    def words(self) -> int:
        """How many words of 32 bits hold a set of actions."""
        return max(1, -(-len(self.actions) // 32))

    @classmethod
    def of(cls, request: Request) -> Names:
        """The names for a policy, from the name of its file."""
        vocabulary = request.policy.vocabulary
        prefix = identifier(request.name)
        upper = prefix.upper() if prefix.upper() != prefix else f"{prefix}_"
        ours = {f"{prefix}_{each}" for each in ("state", "actions", "action", "status", "decide", "executes")}
        theirs = {f"{upper}_{each}" for each in ("ACTION_COUNT", "WORD_COUNT", "INVALID", "UNDECIDED", "DECIDED", "H")}
        wanted: dict[tuple[str, ...], str] = {}
        for name, values in vocabulary.variables:
            wanted["type", name] = f"{prefix}_{name}"
            for value in values:
                wanted["value", name, value] = f"{upper}_{identifier(f'{name}_{value}')}"
        for action in vocabulary.actions:
            wanted["action", action] = f"{upper}_{action}"
        found = distinct(wanted, ours | theirs)
        fields = distinct({name: identifier(name) for name, _ in vocabulary.variables}, WORDS.split())
        return cls(
            prefix,
            upper,
            tuple(found["type", name] for name, _ in vocabulary.variables),
            tuple(fields[name] for name, _ in vocabulary.variables),
            tuple(tuple(found["value", name, value] for value in values) for name, values in vocabulary.variables),
            tuple(found["action", action] for action in vocabulary.actions),
        )
