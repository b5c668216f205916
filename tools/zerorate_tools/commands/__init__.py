"""A module a sub-command: `add_parser` registers it, `run` is a thin call of a public function."""
