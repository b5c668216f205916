"""The host side of zerorate: recordings, replay, the loop, and the interpreters they run on.

The public names below are imported when they are first used, so that nothing costs start-up time.
"""

from importlib import import_module
from typing import TYPE_CHECKING

__version__ = "0.1.0"

if TYPE_CHECKING:
    from .importers import import_recording as import_recording
    from .importers import read_foreign as read_foreign
    from .recordings import Recording as Recording
    from .recordings import Scales as Scales
    from .recordings import open_recording as open_recording
    from .recordings import read_recording as read_recording
    from .recordings import write_recording as write_recording
    from .simulate import simulate_sessions as simulate_sessions

_HOME = {
    "import_recording": "importers",
    "read_foreign": "importers",
    "Recording": "recordings",
    "Scales": "recordings",
    "open_recording": "recordings",
    "read_recording": "recordings",
    "write_recording": "recordings",
    "simulate_sessions": "simulate",
}
__all__ = list(_HOME)


def __getattr__(name: str) -> object:
    if name in _HOME:
        return getattr(import_module(f".{_HOME[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOME})
