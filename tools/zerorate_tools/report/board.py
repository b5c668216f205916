"""How the model gets onto a board: commands and lines that can be copied as they stand."""

import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

_LOAD = """\
from zerorate.model import EffectModel
from zerorate.effects.model_file import LOADED, REASONS

effects = EffectModel()
reason = effects.load_file("model.bin", corrector.sensor, imu.binding)
if reason == LOADED:
    corrector.use_model(effects)
else:
    print("model.bin is not used:", REASONS[reason])
"""


@dataclass(frozen=True)
class Deployment:
    """Shell commands, lines for the program after `corrector` was made, and for its loop."""

    commands: str
    program: str
    each_reading: str


def deployment(folder: Path, channels: Sequence[str]) -> Deployment:
    """What to type and to write for the model in `folder`, which follows these extra channels."""
    model = shlex.quote(str(folder / "model.bin"))
    commands = f"zerorate model check {model}\nzerorate flash /dev/ttyACM0 --model {model}\n"
    lines = [f"effects.channel({name!r}, {_variable(name)})" for name in channels]
    return Deployment(commands, _LOAD, "".join(f"{line}\n" for line in lines))


def _variable(name: str) -> str:
    return name if name.isidentifier() and name.isascii() else "value"
