"""What decisions say of one state, given by names."""

from tumato_symbolic.policy.lookup.deciders import Decider, UndecidedState, make_decider
from tumato_symbolic.policy.lookup.states import parse_assignments, parse_state
