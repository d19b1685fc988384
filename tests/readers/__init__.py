"""The two readers, the package and `proofs/checker.py`: both accept or refuse a file alike, and read the same in it."""
