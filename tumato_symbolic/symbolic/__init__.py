"""Sets of states and steps as BDDs; the only room that knows dd."""
