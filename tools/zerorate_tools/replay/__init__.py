"""The firmware over a recording, learning as it goes."""

from .replaying import AT_REST_ALONE, Replay, replay

__all__ = ["AT_REST_ALONE", "Replay", "replay"]
