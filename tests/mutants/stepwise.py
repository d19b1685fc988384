"""Mutants where safety may take several steps to restore, or rules are of several severities."""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path
from random import Random

from msgspec.structs import replace

from tests.checker.stepwise import MODES, stepwise_spec, ways
from tests.mutants import by_coq, policies, restoring, specs
from tests.mutants.by_coq import Question
from tests.mutants.campaign import Mutant, Tally, bases_of, judge, renew_digest
from tests.mutants.unrealizable import examine_text
from tests.printing import print_spec
from tests.restoration.campaign import specifications
from tests.restoration.test_repair import LOOP, crossing
from tumato_symbolic import parse
from tumato_symbolic.spec import Spec


def texts(seed: int) -> Iterator[tuple[str, str]]:
    """The specifications of a seed, each with an effect ordering of its own: one with a deviation, some of each mode.

    A policy that says how it restores is rare where there are three tiers, so that there are more of these.
    """
    random = Random(f"texts {seed}")
    deviating = (crossing(north="right"), crossing(north="right", south="right"), parse(LOOP))
    known = replace(random.choice(deviating), restoration=random.choice(("bounded", "fair")))
    drawn = [("known", known), *specifications(seed)]
    for restoration, tiers in MODES:
        drawn.append((f"drawn {restoration} {tiers}", stepwise_spec(seed, restoration, tiers)))
        drawn += [
            (f"ways {number} {restoration} {tiers}", ways(9 * seed + number, restoration, tiers))
            for number in range(tiers)
        ]
    for name, spec in drawn:
        ordered = replace(_numbered(spec), effect_ordering=random.choice((None, "any", "first")))
        yield name, print_spec(ordered, random)


def _numbered(spec: Spec) -> Spec:
    actions = (replace(action, name=f"act{number}") for number, action in enumerate(spec.actions))
    return replace(spec, actions=tuple(actions))


def examine_stepwise(seed: int, count: int, folder: Path, *, coq: bool = False) -> Tally:
    """Up to `count` mutants of each specification of a seed that has a policy that says how it restores.

    Of those without a policy, as many of certificates that there is none. With `coq`, policies go through the checker
    in Coq as well.
    """
    tally, for_coq = Tally(), list[tuple[str, Question]]()
    for name, text in texts(seed):
        bases = bases_of(text)
        if not bases:
            tally.add(examine_text(text, f"restoration, seed {seed}, {name}", count, folder))
        if not bases or "Restoring" not in bases[0].get("Certificate", {}):
            continue
        for mutant in _mutants(bases, text, Random(f"{name} {seed}"), count):
            named, asked = f"restoration, seed {seed}, {name}, {mutant.kind}", list[Question]()
            tally.complaints += [f"{named}: {each}" for each in judge(mutant, text, tally, folder, asked)]
            for_coq += [(named, question) for question in asked]
    if coq:
        tally.complaints += by_coq.examine(for_coq, folder, tally.by_coq)
    return tally


def _mutants(bases: list[policies.Document], text: str, random: Random, count: int) -> Iterator[Mutant]:
    spec = parse(text)
    for _ in range(count):
        document, lines = deepcopy(random.choice(bases)), text.splitlines()
        which = random.choice(("restoring", "restoring", "unsafe", "policy", "certificate", "severities", "meaning"))
        if which in ("severities", "meaning"):
            kind, change = random.choice([*(specs.RESTORING if which == "severities" else specs.MEANT).items()])
            change(lines, random)
            if random.random() < 0.7:
                renew_digest(document, lines)
        elif which == "unsafe":
            kind, document = "another decision", deepcopy(bases[0])
            restoring.unsafe_decision(spec)(document, random)
        else:
            form = policies.TABLE if document["Type"] == "policy" else policies.DIAGRAM
            kinds = {"restoring": restoring.CERTIFICATE, "policy": form, "certificate": policies.CERTIFICATE}[which]
            kind, mutate = random.choice([*kinds.items()])
            mutate(document, random)
        if document not in bases or lines != text.splitlines():
            yield Mutant(f"{which}: {kind}", document, "\n".join(lines) + "\n")
