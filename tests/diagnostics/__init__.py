"""Codes and their rendering."""
