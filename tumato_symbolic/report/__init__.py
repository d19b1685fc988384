"""What is printed: text, JSON, annotations."""
