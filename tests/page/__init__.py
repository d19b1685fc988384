"""The page that `report` writes: what it carries, its judge in JavaScript, and how it behaves in a browser."""
