"""The lines of exported C and of what builders read that `export_c` fills in."""

from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

from zerorate import Sensor
from zerorate_tools.kernels import export
from zerorate_tools.model import Slot, build_model, write_model
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales


def _templates():
    files = Path(export.__file__).with_name("exported").rglob("*")
    texts = [path.read_text(encoding="utf-8") for path in files if path.is_file()]
    texts += [text for text in vars(export).values() if isinstance(text, str)]
    return {line for text in texts for line in text.splitlines()}


def _model(folder):
    slots = [
        Slot(Term("temp", 0.0, 50.0, 5.0), (0.01, 0.02, -0.03)),
        Slot(Term("load", 0, 90), (1e-3,) * 3),
    ]
    return write_model(build_model(slots, Scales("MPU-6500", 30, 65.5, 8192, 333.87, 21)), folder)


def exported():
    """Of an export for a sensor; and what is not in it of one with a model that has a channel."""
    found, told = {}, _templates()
    with (
        TemporaryDirectory() as folder,
        mock.patch.multiple(
            export, __version__="3.14.15", kernels_in_c=lambda _, *entries: f"/* {entries} */"
        ),
    ):
        model = _model(Path(folder, "model"))[1]
        sensor = Sensor(700, 32.8, 4096, 326.8, 35)
        for way, how in (("sensor", {"sensor": sensor}), ("model", {"model": model})):
            for path in export.export_c(Path(folder, way), **how):
                lines = path.read_text(encoding="utf-8").splitlines()
                name = path.relative_to(Path(folder, way))
                found[f"{way} {name}"] = [line for line in lines if line not in told]
            told |= {line for lines in found.values() for line in lines}
    return {name: lines for name, lines in found.items() if lines}
