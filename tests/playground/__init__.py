"""The playground: what it asks of the package, what it is put together from, and how it behaves in a browser."""
