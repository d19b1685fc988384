"""The game that a policy plays: steps, targets, the fixpoints over them, and how well a policy does."""

from tumato_symbolic.game.alone import Alone, alone, chances, way_of, winning_alone
from tumato_symbolic.game.evaluation import Evaluation, Evaluator, in_time, winning
from tumato_symbolic.game.fixpoints import (
    ClosedLoop,
    Layers,
    attractor,
    by_any_step,
    closed_loop,
    distances,
    mixed,
)
from tumato_symbolic.game.problem import Problem, build_problem, with_all_sets, with_goals
from tumato_symbolic.game.reevaluation import Reevaluator
from tumato_symbolic.game.restoration import Restoration, Restorer
from tumato_symbolic.game.routing import OwnRegions, only_region, own_region_policy, route, shortest_decisions
