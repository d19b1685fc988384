"""Certificates of unrealizability, proved by Z3 and decision diagrams (`docs/certificate.md`)."""
