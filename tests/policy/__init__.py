"""Policies as data: files, conversion, binding, lookup."""
