"""Sets of states and steps as BDDs; the only room that knows dd."""

from tumato_symbolic.symbolic.choose import by_duration, lasting, least_duration, preferred
from tumato_symbolic.symbolic.encoding import Encoding, encode
from tumato_symbolic.symbolic.extract import Extractor
from tumato_symbolic.symbolic.few import few_steps
from tumato_symbolic.symbolic.goals import (
    Regions,
    Target,
    never_entered,
    one_by_one,
    regions,
    regions_apart,
    targets,
    together,
    with_own_bits,
)
from tumato_symbolic.symbolic.layout import lay_out
from tumato_symbolic.symbolic.manager import Backend, Bdd, Manager, TooManyNodesError, available_backend
from tumato_symbolic.symbolic.present import Leading
from tumato_symbolic.symbolic.steps import (
    Steps,
    applicable_parts,
    build_steps,
    compatible_sets,
    meant_sets,
    staying_in,
    tiers_within,
    without_effect,
)
from tumato_symbolic.symbolic.turns import Rounds, Turn, in_turns
