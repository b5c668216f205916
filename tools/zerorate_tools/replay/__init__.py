"""The firmware over a recording, learning as it goes."""

from .run import Replay, replay

__all__ = ["Replay", "replay"]
