"""Policies proved by walking over ordered diagrams, without Z3 (`docs/certificate.md`, "The walk")."""
