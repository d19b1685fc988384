"""The language server: the protocol around what `editor` knows. The only room that knows pygls."""
