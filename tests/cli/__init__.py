"""The command line, as scripts and people see it."""
