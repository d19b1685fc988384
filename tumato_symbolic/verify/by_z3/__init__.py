"""Policies proved by Z3 (`docs/certificate.md`, "The obligations")."""
