"""The same specification gives the same bytes: in one process, in another one, and on both backends."""
