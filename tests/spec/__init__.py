"""Names, effects, lint, digests."""
