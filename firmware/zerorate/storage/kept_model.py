"""The effect model of a LearnedStore, in two slots behind those of the state."""

# layout: names that a board's own compiler reads
const = int
# layout: What the reader of model.bin says
_LOADED = const(0)
# layout: end


def load(store, at_size):
    """The bytes of the model that store holds, whose size is the word of 16 bits at at_size."""
    padded = bytearray(store.size)
    if store.load(padded) != _LOADED:
        return b""
    return bytes(padded[: padded[at_size] | padded[at_size + 1] << 8])


def save(store, data):
    """Write data to store; ValueError where it is too large."""
    if len(data) > store.size:
        raise ValueError(f"a model of {len(data)} bytes does not fit {store.size}")
    return store.save(bytes(data) + bytes(store.size - len(data)))
