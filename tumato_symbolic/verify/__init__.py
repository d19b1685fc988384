"""Proofs about policies, with Z3 and the specification alone."""
