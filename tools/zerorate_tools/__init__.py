"""The host side of zerorate: recordings, replay, the loop, and the interpreters they run on.

    import zerorate_tools as zt

    recording = zt.read_recording("run.parquet")
    recording.to_frame(physical=True)               # a pandas DataFrame in dps, g and degC
    replayed = zt.replay_recording(recording)       # the firmware over it
    zt.plot_replay(recording, replayed).show()
    zt.close_loop(["run-1.parquet", "run-2.parquet"], "closed")

The public names below are imported when they are first used, so that nothing costs start-up time.
"""

from importlib import import_module
from typing import TYPE_CHECKING

__version__ = "0.1.0"

if TYPE_CHECKING:
    from .closing import close as close_loop
    from .errors import ZerorateError as ZerorateError
    from .importers import import_recording as import_recording
    from .importers import read_foreign as read_foreign
    from .loop.read.stretch import deviation_of as allan_deviation
    from .model import Model as Model
    from .model import read_model as read_model
    from .model import write_model as write_model
    from .recordings import Recording as Recording
    from .recordings import Scales as Scales
    from .recordings import open_recording as open_recording
    from .recordings import read_recording as read_recording
    from .recordings import write_recording as write_recording
    from .replay import Replay as Replay
    from .replay import replay as replay_recording
    from .replay.plot import plot as plot_replay
    from .simulate import simulate_sessions as simulate_sessions

#: Public name -> the module it lives in, and its name there.
_HOME = {
    "Recording": ("recordings", "Recording"),
    "Scales": ("recordings", "Scales"),
    "read_recording": ("recordings", "read_recording"),
    "open_recording": ("recordings", "open_recording"),
    "write_recording": ("recordings", "write_recording"),
    "import_recording": ("importers", "import_recording"),
    "read_foreign": ("importers", "read_foreign"),
    "simulate_sessions": ("simulate", "simulate_sessions"),
    "replay_recording": ("replay", "replay"),
    "Replay": ("replay", "Replay"),
    "plot_replay": ("replay.plot", "plot"),
    "close_loop": ("closing", "close"),
    "allan_deviation": ("loop.read.stretch", "deviation_of"),
    "read_model": ("model", "read_model"),
    "write_model": ("model", "write_model"),
    "Model": ("model", "Model"),
    "ZerorateError": ("errors", "ZerorateError"),
}
__all__ = [
    "Recording",
    "Scales",
    "read_recording",
    "open_recording",
    "write_recording",
    "import_recording",
    "read_foreign",
    "simulate_sessions",
    "replay_recording",
    "Replay",
    "plot_replay",
    "close_loop",
    "allan_deviation",
    "read_model",
    "write_model",
    "Model",
    "ZerorateError",
]


# a type checker sees the imports above, and a wrong name as such
if not TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        if name in _HOME:
            module, attribute = _HOME[name]
            return getattr(import_module(f".{module}", __name__), attribute)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

    def __dir__() -> list[str]:
        return sorted({*globals(), *_HOME})
