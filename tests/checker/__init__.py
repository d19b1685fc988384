"""Tests of `proofs/checker.py`, the stand-alone checker."""
