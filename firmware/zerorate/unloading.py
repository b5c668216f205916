"""Modules that only a constructor needs give their memory back on a board."""

import sys


def unload(package, name):
    """Let the module `name` of `package` go; it is loaded again by whoever imports it again."""
    if sys.implementation.name == "micropython":
        sys.modules.pop(package + "." + name, None)
        sys.modules[package].__dict__.pop(name, None)
