"""The host side of zerorate: recordings, replay, the loop, and the interpreters they run on.

    import zerorate_tools as zt

    recording = zt.read_recording("run.parquet")
    recording.to_frame(physical=True)          # a pandas DataFrame in dps, g and degC
    replayed = zt.replay_recording(recording)  # the firmware over it
    zt.plot_replay(recording, replayed).show()
    zt.close_loop(["run-1.parquet", "run-2.parquet"], "closed")

The public names below are imported when they are first used, so that nothing costs start-up time.
"""

from importlib import import_module
from typing import TYPE_CHECKING

__version__ = "0.1.0"

if TYPE_CHECKING:
    from .closing import close as close_loop
    from .errors import ZerorateError
    from .importers import import_recording, read_foreign
    from .loop.read.still import deviation_of as allan_deviation
    from .loop.report.result import LoopReport
    from .model import Model, read_model, write_model
    from .recordings import Recording, Scales, open_recording, read_recording, write_recording
    from .replay import Replay
    from .replay import replay as replay_recording
    from .replay.plot import plot as plot_replay
    from .simulate import simulate_sessions

#: Module -> the public names that live in it, `=` its name there where it has another.
_HOME = {
    "recordings": "Recording Scales read_recording open_recording write_recording",
    "importers": "import_recording read_foreign",
    "simulate": "simulate_sessions",
    "replay": "replay_recording=replay Replay",
    "replay.plot": "plot_replay=plot",
    "closing": "close_loop=close",
    "loop.report.result": "LoopReport",
    "loop.read.still": "allan_deviation=deviation_of",
    "model": "read_model write_model Model",
    "errors": "ZerorateError",
}
__all__ = [
    "Recording", "Scales", "read_recording", "open_recording", "write_recording",
    "import_recording", "read_foreign", "simulate_sessions", "replay_recording", "Replay",
    "plot_replay", "close_loop", "LoopReport", "allan_deviation", "read_model", "write_model",
    "Model", "ZerorateError",
]  # fmt: skip


# a type checker sees the imports above, and a wrong name as such
if not TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        for module, names in _HOME.items():
            for public, _, attribute in (word.partition("=") for word in names.split()):
                if name == public:
                    return getattr(import_module(f".{module}", __name__), attribute or public)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

    def __dir__() -> list[str]:
        return sorted({*globals(), *__all__})
