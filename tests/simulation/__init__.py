"""Executions of policies."""
