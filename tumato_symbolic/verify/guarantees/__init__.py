"""What a policy guarantees beyond its nominal runs, for all states at once, by the walk."""
