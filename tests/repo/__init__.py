"""The repository itself: documents, examples, proofs, packages."""
