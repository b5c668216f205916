"""Binary logs as tables, each read in a process of its own."""
