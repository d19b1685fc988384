"""Certificates that are cut off, inflated or partly null, with largest numbers beside powers of two."""
