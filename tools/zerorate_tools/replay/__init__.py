"""The firmware over a recording, learning as it goes."""

from .replaying import Replay, replay

__all__ = ["Replay", "replay"]
