"""A model in its two files."""

from os import PathLike
from pathlib import Path

from ..errors import BadModel
from ..recordings.atomic import written_together
from ..recordings.drafts import settle
from .binary import decoded, encoded
from .model import CannotDeploy, Model
from .text import from_json, to_json

_MOST_BYTES = 1 << 20


def read_model(path: str | PathLike[str]) -> Model:
    """The model in a model.bin or model.json, told apart by what is in it. Raises BadModel.

    One from model.json is as its integers hold it, as if it had been read from its model.bin.
    """
    path = Path(path)
    settle(path.parent)
    try:
        if path.exists() and not path.is_file():  # a device has no end, a pipe may have no writer
            raise BadModel(path, "is no file", do="name a model.bin or model.json")
        with open(path, "rb") as file:
            data = file.read(_MOST_BYTES + 1)
    except OSError as error:
        problem = "no such file" if not path.exists() else f"cannot be read: {error.strerror}"
        raise BadModel(path, problem, do="name a model.bin or model.json") from error
    if len(data) > _MOST_BYTES:
        raise BadModel(path, "too large for an effect model", do="name a model.bin or model.json")
    if data[:1] != b"{" and data.lstrip()[:1] != b"{":
        return decoded(data, path)
    model = from_json(data, path)
    try:
        return decoded(encoded(model), path)
    except CannotDeploy as error:
        raise BadModel(path, str(error), do="correct it") from error


def write_model(model: Model, folder: str | PathLike[str]) -> tuple[Path, Path]:
    """Write model.json and model.bin into the folder; return their paths. Raises ZerorateError."""
    data = encoded(model)
    with written_together(folder) as draft:
        (draft / "model.json").write_text(to_json(decoded(data)), encoding="utf-8")
        (draft / "model.bin").write_bytes(data)
    return Path(folder) / "model.json", Path(folder) / "model.bin"
