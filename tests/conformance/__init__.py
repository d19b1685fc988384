"""The rules of docs/semantics.md, each put to every engine that claims to follow it."""
