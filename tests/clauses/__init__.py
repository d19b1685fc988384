"""Actions whose effects depend on the state, against the same written out as actions that exclude each other."""
