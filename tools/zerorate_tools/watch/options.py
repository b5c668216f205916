"""How to watch."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .screen import Lines, Screen


@dataclass(frozen=True)
class WatchOptions:
    """How to watch.

    seconds: end after so long; once: end with what is there; every_s: between two looks (default
    0.5 on a terminal, 2 in a pipe); settings, model: as of Live; setup: as of
    record_port; own: show what the board's own program prints, and leave it running.
    """

    seconds: float | None = None
    once: bool = False
    every_s: float | None = None
    plain: bool = False
    settings: dict[str, Any] | None = None
    model: Path | None = None
    setup: str = ""
    own: bool = False

    def seconds_between_looks(self, shown: Screen) -> float:
        """Seconds between two looks on that screen."""
        if self.every_s is not None:
            return self.every_s
        return 2.0 if isinstance(shown, Lines) else 0.5
