"""Policies as data: tables, diagrams, their files."""
