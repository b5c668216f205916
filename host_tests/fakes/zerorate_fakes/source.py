"""Where a fake chip's samples come from: one iterator of 7-int samples out of several forms."""


def samples_of(source):
    """Iterator of 7 ints (ax ay az temp gx gy gz, raw LSB) over source.

    source is None (zeros for ever), bytes or bytearray of 14-byte big-endian frames as the chip's
    data registers hold them, a flat array of 7 ints a sample, or any iterable of samples.
    """
    if source is None:
        return _zeros()
    if isinstance(source, (bytes, bytearray, memoryview)):
        return _frames(source)
    try:
        flat = len(source) and isinstance(source[0], int)
    except TypeError:
        return iter(source)
    return _flat(source) if flat else iter(source)


def _zeros():
    while True:
        yield (0, 0, 0, 0, 0, 0, 0)


def _frames(block):
    for start in range(0, len(block) - 13, 14):
        sample = []
        for i in range(start, start + 14, 2):
            word = block[i] << 8 | block[i + 1]
            sample.append(word - ((word & 0x8000) << 1))
        yield sample


def _flat(block):
    for start in range(0, len(block) - 6, 7):
        yield block[start : start + 7]
