"""The command line, for the tests here."""

from tests.cli.conftest import cli

__all__ = ["cli"]
