"""Explicit-state checking: the meaning of a policy, one decided state at a time, without Z3 and without diagrams."""
