"""The effect model of a LearnedStore, in two slots behind those of the state."""

from struct import unpack_from

from .store import Store

# layout: names that a board's own compiler reads
const = int
# layout: What the reader of model.bin says
_LOADED = const(0)
# layout: end
_AT_MODEL_SIZE = const(4)


def bound(binding, crc):
    """The binding of a state that was learned beside the model of this CRC."""
    binding = bytearray(binding)
    for i in range(len(crc)):
        binding[4 + i] ^= crc[i]
    return bytes(binding)


def load(storage, binding, size, base, pitch):
    """The bytes of the model that a Store of these holds, which say their size."""
    store = Store(storage, binding, size, base=base, pitch=pitch)
    padded = bytearray(size)
    if store.load(padded) != _LOADED:
        return b""
    (length,) = unpack_from("<H", padded, _AT_MODEL_SIZE)
    return bytes(padded[:length])


def save(data, storage, binding, size, base, pitch):
    """Write data to a Store of these; ValueError where it is too large."""
    if len(data) > size:
        raise ValueError(f"a model of {len(data)} bytes does not fit {size}")
    store = Store(storage, binding, size, base=base, pitch=pitch)
    return store.save(bytes(data) + bytes(size - len(data)))
