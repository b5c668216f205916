"""One module a sub-command: its arguments, and a thin call of a public function."""
