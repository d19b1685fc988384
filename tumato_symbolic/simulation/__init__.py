"""Executions of a policy: at random, nominal, or the worst that can happen, one state at a time."""

from tumato_symbolic.simulation.dice import Dice
from tumato_symbolic.simulation.execution import Faults, Simulation, executed, random_move
from tumato_symbolic.simulation.starts import NoStartError, Starts
from tumato_symbolic.simulation.summary import Spread, Summary, summarized
from tumato_symbolic.simulation.worst import MOST_OUTCOMES, worst_case
