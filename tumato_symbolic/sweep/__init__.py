"""Many variants of one specification, each solved as `synth` does it, on one machine or a cluster."""

from tumato_symbolic.sweep.defining import defined, definition
from tumato_symbolic.sweep.dropping import dropped
from tumato_symbolic.sweep.mutating import mutated
from tumato_symbolic.sweep.results import Line, Results, kept, written
from tumato_symbolic.sweep.sweeping import processes, sweep
from tumato_symbolic.sweep.tasks import Task
from tumato_symbolic.sweep.variants import Plan, Variant
