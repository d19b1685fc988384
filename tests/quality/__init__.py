"""The numbers that the paper and the issue state."""
