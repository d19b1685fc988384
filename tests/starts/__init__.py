"""Start states: synthesis and every judge against the literal meaning (`docs/semantics.md`, section 12)."""
