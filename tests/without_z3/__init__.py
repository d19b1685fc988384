"""What works where Z3 cannot be imported."""
