"""A model in its two files."""

from os import PathLike
from pathlib import Path

from ..errors import BadModel
from ..recordings.atomic import written_together
from ..recordings.drafts import settle
from ..small_file import bytes_of
from .binary import decoded, encoded
from .model import CannotDeploy, Model
from .text import from_json, to_json


def read_model(path: str | PathLike[str]) -> Model:
    """The model in a model.bin or model.json, told apart by what is in it. Raises BadModel.

    One from model.json is as its integers hold it, as if it had been read from its model.bin.
    """
    path = Path(path)
    settle(path.parent)
    data = bytes_of(path, "name a model.bin or model.json", BadModel)
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
