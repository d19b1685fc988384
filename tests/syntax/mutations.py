"""Damaged texts, for tests that nothing a user may feed in breaks the reader.

As a script, a campaign: `python -m tests.syntax.mutations 20000 examples/*.tum`.
"""

from __future__ import annotations

import random
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from tumato_symbolic.diagnostics import Diagnostic, Source, render
from tumato_symbolic.spec import load

SNIPPETS = (
    "(", ")", ",", ":", "/*", "*/", "//", "\n", "\t", "\0", "\x1b[31m", "é", "\ufeff", "\u2028", "-1", "0", "9" * 30,
    "2x",
    "BEGIN ", "END ", "BEGIN GOALS ", "END GOALS ", "STATE VECTOR ", "RULES ", "AND ", "OR ", "NOT ", "IF ", "THEN ",
    "IFONLYIF ", "is ", "executing ", "true ", "none ", "when ", "then ", "goal ", "goal: ", "goal type: ", "priority ",
    "rule: ", "assume: ", "define x as x ", "state ", "can be ", "action ", "resource ", "duration: ", "effects: ",
    "nominal ", "alternative effects: ", "controlled resources: ", "max_plan_length: ", "effect_ordering: ",
    "NOT (" * 60, "when S_A is 0: ", "- 1 ", "S_A is S_A + 1, ", "end for ",
)  # fmt: skip


def mutations(text: str, seed: int) -> Iterator[str]:
    """Endlessly many texts near `text`: pieces cut, doubled, swapped, or put in, up to five at once."""
    generator = random.Random(seed)
    while True:
        mutant = text
        for _ in range(generator.randint(1, 5)):
            mutant = _mutated(mutant, generator)
        yield mutant


def _mutated(text: str, generator: random.Random) -> str:
    start = generator.randint(0, len(text))
    end = min(len(text), start + generator.choice((1, 3, 10, 40, 200)))
    place = generator.randint(0, len(text))
    match generator.randint(0, 6):
        case 0:
            return text[:start] + text[end:]
        case 1:
            return text[:end] + text[start:]
        case 2:
            return text[:place] + text[start:end] + text[place:]
        case 3 | 4:
            return text[:start] + generator.choice(SNIPPETS) + text[start:]
        case 5:
            words = text.split(" ")
            words[generator.randrange(len(words))] = generator.choice(words)
            return " ".join(words)
        case _:
            words = text.split(" ")
            place = generator.randrange(len(words))
            words[place] = words[place].swapcase()
            return " ".join(words)


def check(text: str) -> tuple[Diagnostic, ...]:
    """The diagnostics of a text, which are rendered as well. Raises whatever goes wrong."""
    source = Source("mutant", text)
    found = load(source)
    rendered = render(found.diagnostics, source)
    assert (found.spec is None) == any(each.severity == "error" for each in found.diagnostics)
    assert bool(rendered) == bool(found.diagnostics)
    assert "\x1b" not in rendered
    return found.diagnostics


def main() -> None:
    """Check so many mutants of each file as the first argument says, in all."""
    count, paths = int(sys.argv[1]), sys.argv[2:]
    slowest = 0.0
    for number, path in enumerate(paths):
        source = mutations(Path(path).read_text(encoding="utf-8"), number)
        for _, mutant in zip(range(count // len(paths)), source, strict=False):
            try:
                start = time.perf_counter()
                check(mutant)
                slowest = max(slowest, time.perf_counter() - start)
            except BaseException:
                Path("mutant.tum").write_text(mutant, encoding="utf-8")
                raise
    print(f"{count} mutants, none broke the reader; the slowest took {slowest:.2f} s")


if __name__ == "__main__":
    main()
