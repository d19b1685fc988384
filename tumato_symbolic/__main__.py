"""`python -m tumato_symbolic`: the same as `tumato-sym`."""

from tumato_symbolic.cli.main import entry

if __name__ == "__main__":
    entry()
