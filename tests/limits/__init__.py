"""Limits that hold."""
