"""Mutants of the answer no: a certificate that there is no policy, beside a specification, one or both of them changed.

A certificate that is no proof any more need not be false, so not every rejection can be judged. What can: whoever
is told *proved unrealizable* has no policy, and a specification that means the same is still proved by its certificate.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from copy import deepcopy
from random import Random

from tests.generate import random_text
from tests.mutants import specs
from tests.mutants.campaign import LARGEST, Tally
from tests.oracle import World, decide_world
from tests.policy.mutations import mutate
from tests.profiles import PROFILES
from tumato_symbolic import Unrealizable, parse, synthesize
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy.unrealizable_file import dumps, loads
from tumato_symbolic.semantics import all_states, count_states, is_valid
from tumato_symbolic.verify import verify_unrealizable

Document = dict[str, object]


def examine_refusal(profile: str, seed: int, count: int) -> Tally:
    """Up to `count` mutants of one specification, none where it is too large or has a policy."""
    text, tally = random_text(seed, PROFILES[profile]), Tally()
    spec = parse(text)
    if count_states(spec) > LARGEST:
        return tally
    outcome = synthesize(spec)
    if not isinstance(outcome, Unrealizable) or outcome.certificate is None:
        return tally
    document, random = json.loads(dumps(outcome.certificate)), Random(f"{profile} {seed} no")
    for _ in range(count):
        which = random.choice(("layout", "meaning", "meaning", "certificate", "both"))
        changed, lines = deepcopy(document), text.splitlines()
        if which != "certificate":
            kinds = specs.LAYOUT if which == "layout" else specs.MEANT
            random.choice([*kinds.values()])(lines, random)
        if which in ("certificate", "both"):
            changed = mutate(changed, random)
        for complaint in _judge(changed, "\n".join(lines) + "\n", which, tally):
            tally.complaints.append(f"{profile} {seed} no, {which}: {complaint}")
    return tally


def _judge(document: Document, text: str, which: str, tally: Tally) -> Iterator[str]:
    try:
        spec = parse(text)
    except UserError:
        return
    if not any(is_valid(spec, state) for state in all_states(spec)):
        return
    tally.mutants += 1
    try:
        found = verify_unrealizable(loads(json.dumps(document)), spec)
    except UserError:
        tally.unreadable += 1
        return
    proved = found.verdict == "proved"
    tally.right += proved
    tally.kinds[f"no, {which}", proved] += 1
    if proved and decide_world(World(spec, found.ordering)).kind == "realizable":
        yield "proved unrealizable, but there is a policy"
    if which == "layout" and (not proved or found.stale):
        yield f"{found.verdict}, stale: {found.stale}, for the same meaning"
