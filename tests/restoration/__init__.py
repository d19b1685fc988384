"""Restoring safety in several steps, and by severity: the engine against the explicit meaning."""
