"""The command line: what may be typed, what is printed, and the exit codes."""
