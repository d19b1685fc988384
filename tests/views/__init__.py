"""Policies looked at."""
