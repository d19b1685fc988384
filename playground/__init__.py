"""The package in a browser: pages, a worker that runs Python, and what puts them together (`make playground`)."""
