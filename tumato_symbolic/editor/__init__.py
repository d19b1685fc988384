"""What editors ask for: functions from a text to records. Imports no server; `lsp` is one."""
