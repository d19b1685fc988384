"""Mutants of unrealizability: a certificate beside a specification, one or both of them changed.

A certificate that is no proof any more need not be false, so not every rejection can be judged by what is true. What
can: whoever is told *proved unrealizable* has no policy; a specification that means the same is still proved by its
certificate; and `verify` and the stand-alone checker accept the same certificates.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from copy import deepcopy
from functools import lru_cache
from pathlib import Path
from random import Random

from msgspec.structs import replace

from tests.checker.standalone import ask
from tests.generate import random_spec, random_text
from tests.mutants import cubes_and_layers, specs
from tests.mutants.campaign import LARGEST, Tally
from tests.mutants.changes import Document
from tests.oracle import World, decide_world
from tests.policy.mutations import mutate
from tests.printing import print_spec
from tests.profiles import ALL_PROFILES
from tests.restoration.oracle import decide_stepwise
from tests.unrealizability import CONFLICTS
from tests.verify.test_no_restoration import holds_fast
from tumato_symbolic import Unrealizable, parse, synthesize
from tumato_symbolic.diagnostics import Code, UserError
from tumato_symbolic.policy.unrealizability import NoRestoration, bind, dumps, loads
from tumato_symbolic.semantics import all_states, count_states, is_valid
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify import verify_unrealizable

WAYS = ("layout", "meaning", "file", "both", "certificate", "certificate", "certificate", "certificate")


def examine_unrealizable(profile: str, seed: int, count: int, folder: Path) -> Tally:
    """Up to `count` mutants of one specification, none where it is too large or has a policy."""
    text = random_text(seed, ALL_PROFILES[profile])
    if count_states(parse(text)) > LARGEST:
        return Tally()
    return examine_text(text, f"{profile} {seed}", count, folder)


def examine_conflict(number: int, count: int, folder: Path) -> Tally:
    """Mutants of a specification whose goals conflict, with the bound that the number gives it."""
    seed, bound = CONFLICTS[number % len(CONFLICTS)], number // len(CONFLICTS) % 8 or None
    spec = replace(random_spec(seed, ALL_PROFILES["interacting"]), max_plan_length=bound)
    return examine_text(print_spec(spec, Random(seed)), f"conflict {number}", count, folder)


def examine_text(text: str, name: str, count: int, folder: Path) -> Tally:
    """Up to `count` mutants of one specification, none where it has a policy."""
    tally, random = Tally(), Random(f"{name} no")
    ordering: Ordering | None = random.choice((None, None, "first"))
    outcome = synthesize(parse(text), ordering)
    if not isinstance(outcome, Unrealizable) or outcome.certificate is None:
        return tally
    document = json.loads(dumps(outcome.certificate))
    kinds = cubes_and_layers.BY_KIND[document["Reason"]["Kind"]]
    meant = {**specs.MEANT, **specs.RESTORING} if parse(text).restores_stepwise else specs.MEANT
    for _ in range(count):
        which, changed, lines = random.choice(WAYS), deepcopy(document), text.splitlines()
        if which in ("layout", "meaning", "both"):
            random.choice([*(specs.LAYOUT if which == "layout" else meant).values()])(lines, random)
        if which in ("certificate", "both"):
            for _ in range(random.choice((1, 1, 1, 2, 3))):
                kind, change = random.choice([*kinds.items()])
                change(changed, random)
                which = f"{document['Reason']['Kind']}: {kind}" if which == "certificate" else which
        if which == "file":
            changed = mutate(changed, random)
        for complaint in _judge(changed, "\n".join(lines) + "\n", which, tally, folder):
            tally.complaints.append(f"{name} no, {which}: {complaint}")
    return tally


def _judge(document: Document, text: str, which: str, tally: Tally, folder: Path) -> Iterator[str]:
    spec = _read(text)
    if spec is None:
        return
    tally.mutants += 1
    tally.forms["unrealizable"] += 1
    written = json.dumps(document)
    answer = ask(folder, written, text)
    if answer.code == 70:
        yield f"the checker breaks: {answer.err}"
    if spec.restores_stepwise:
        tally.modes[f"no, {spec.restoration}, {len(spec.tiers)} tiers"] += 1
    try:
        certificate = loads(written)
        found = verify_unrealizable(certificate, spec)
    except UserError as error:
        unsupported = error.diagnostics[0].code == Code.TUM313
        tally.unreadable += not unsupported
        if answer.code == 0 and (not unsupported or _realizable(text, certificate.ordering)):
            yield f"the checker accepts it: {error}"
        return
    proved = found.verdict == "proved"
    tally.right += proved
    tally.kinds[f"no, {which}", proved] += 1
    if found.verdict != "undecided" and answer.code != 3 and proved != (answer.code == 0):
        tally.disagreements += 1
        yield f"{found.verdict} ({found.reason}), but the checker: {answer.out}{answer.err}"
    if answer.code == 0 and ("STALE" in answer.out) != found.stale:
        yield "the checker and `verify` disagree on whether it is stale"
    if (proved or answer.code == 0) and _realizable(text, found.ordering):
        yield "proved unrealizable, but there is a policy"
    reason = bind(certificate, spec).reason
    if isinstance(reason, NoRestoration) and (found.ordering, spec.ordering) != ("any", "first"):
        trap = {state for state in all_states(spec) if reason.diagram.evaluate(reason.root, state)}
        held = spec.restoration != "one_step" and holds_fast(spec, reason.state, trap, found.ordering)
        if proved != held:
            yield f"{found.verdict} ({found.reason}), and it is {'' if held else 'no '}trap"
    if which == "layout" and (not proved or found.stale):
        yield f"{found.verdict}, stale: {found.stale}, for the same meaning"


@lru_cache
def _read(text: str) -> Spec | None:
    """The specification; None where it is in error, or has no valid state."""
    try:
        spec = parse(text)
    except UserError:
        return None
    return spec if any(is_valid(spec, state) for state in all_states(spec)) else None


@lru_cache
def _realizable(text: str, ordering: Ordering) -> bool:
    spec = parse(text)
    if spec.restores_stepwise:
        return decide_stepwise(spec, ordering).policy is not None
    return decide_world(World(spec, ordering)).kind == "realizable"
