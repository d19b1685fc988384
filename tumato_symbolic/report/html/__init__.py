"""A policy, or that there is none, as one page for a browser, which checks what it shows by itself."""
