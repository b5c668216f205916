"""The host side of zerorate: recordings, replay, the loop, and the interpreters they run on."""

__version__ = "0.1.0"
