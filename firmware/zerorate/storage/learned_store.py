"""All that a device has learned, and its effect model, on one storage: a store for each.

The state changes all day and the model when a person brings one, so each has its own two slots:
a cut in the writing of one never costs the other.
"""

from ..machine_code import unload
from .crc32 import checksum
from .store import Store, packed, slot_bytes

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from ..corrector import Corrector

# layout: names that a board's own compiler reads
const = int
# layout: The corrector's settings
_STEP_LSB = const(29)
# layout: What the reader of model.bin says
_LOADED = const(0)
# layout: What a store says
_OTHER_BINDING = const(3)
# layout: end
MODEL_BYTES = const(2048)
_STATE_VERSION = const(2)


class LearnedStore:
    """The stores of `corrector`, a Corrector, on `storage` (see storage.py) from byte `base` on.

    binding: MPU6050.binding, the chip's id, range and filter. The state is also bound to the
    corrector's settings, which go with it into the record, and to its effect model: the curve over
    temperature is what the model leaves. So call use_model before load. pitch: distance of slots,
    an erase block of flash (default: no gap). end is the first byte behind both. Raises ValueError
    for a pitch that is too small.
    """

    def __init__(
        self,
        storage: "Any",
        binding: bytes,
        corrector: "Corrector",
        base: int = 0,
        pitch: int = 0,
    ) -> None:
        self.corrector = corrector
        size = 4 * len(corrector.state)
        self._bound = bytes(binding) + _fingerprint(corrector)
        self.state = Store(
            storage, self._bound, size, _STATE_VERSION, base, pitch, corrector.settings
        )
        base += 2 * (pitch or self.state.slot_bytes)
        self._model_place = (storage, binding, MODEL_BYTES, base, pitch)
        self.end = base + 2 * (pitch or slot_bytes(MODEL_BYTES))

    def load(self, same: bool = False) -> int:
        """Put what was learned into the corrector and begin a power-on; LOADED or why not.

        same: the chip kept its power (MPU6050.kept_power), only the program began anew.
        in_words says each result; the corrector is as it was when it is not LOADED.
        """
        self._bind()
        reason = self.corrector.load(self.state, same)
        self.loaded = reason == _LOADED
        return reason

    def in_words(self, reason: int) -> str:
        """What load returned, in words; of another binding also what of it or which setting.

        A board names that only where it has the part `differing`.
        """
        if reason == _OTHER_BINDING:
            try:
                from .differing import differing

                text = differing(self.state, self.corrector)
                unload("zerorate.storage", "differing")
                return text
            except ImportError:
                pass
        from .reasons import REASONS

        unload("zerorate.storage", "reasons")
        return REASONS[reason]

    def save(self, payload: "Any" = None) -> bool:
        """Write what the corrector has learned; False when the storage failed.

        payload is for SaveSchedule, which hands over the corrector's state.
        """
        self._bind()
        return self.corrector.save(self.state)

    def _bind(self):
        if self.corrector.effects is not None:
            from .kept_model import bound  # who has no model has no memory taken by it

            self.state.binding = bound(self._bound, self.corrector.effects.crc)

    def load_model(self) -> bytes:
        """The bytes of the effect model, for EffectModel.load, or b"" (see model.load's reason).

        Raises ImportError on a board without the part `effects`.
        """
        from .kept_model import load

        return load(*self._model_place)

    def save_model(self, data: bytes) -> bool:
        """Write an effect model, the bytes of model.bin; False when the storage failed.

        Raises ValueError for one that is too large, ImportError as load_model.
        """
        from .kept_model import save

        return save(data, *self._model_place)


def _fingerprint(corrector):
    """Four bytes that differ between settings, as they are without an effect model."""
    out, settings = bytearray(4), corrector.settings
    step = settings[_STEP_LSB]
    settings[_STEP_LSB] = corrector._step_lsb
    checksum(packed(settings, 4 * len(settings)), out)
    settings[_STEP_LSB] = step
    return bytes(out)
