"""Effect models: model.json, its twin model.bin, and what is in them."""

from .binary import build_model, decoded, drafted, encoded
from .files import from_json, read_model, to_json, write_model
from .model import Binding, CannotDeploy, Input, Model, Slot

__all__ = (
    "Binding", "CannotDeploy", "Input", "Model", "Slot", "build_model", "drafted", "decoded",
    "encoded", "from_json", "read_model", "to_json", "write_model",
)  # fmt: skip
