"""Policies in the formats of other tools: one target, one file, and a line in `export/targets.py`."""
