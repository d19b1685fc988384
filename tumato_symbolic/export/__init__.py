"""Policies in the formats of other tools: one target, one file."""
