"""Learned state kept over a power cut: two slots, the newest whole one counts.

A record is  "ZRS" format version size sequence binding payload crc32  with little-endian numbers
(1, 2, 2, 4, 8 bytes) and CRC-32 of all before it; size is that of payload and what goes with it. A
save writes the slot that does not hold the
newest whole record, so until the last byte stands the one before it is whole.
"""

import gc
from array import array
from sys import byteorder, implementation

from .crc32 import checksum

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

# layout: names that a board's own compiler reads
const = int
# layout: What the reader of model.bin says
_LOADED = const(0)
_DAMAGED = const(2)
_OTHER_VERSION = const(4)
_UNREADABLE = const(6)
# layout: What a store says
_EMPTY = const(1)
_OTHER_BINDING = const(3)
_OTHER_SIZE = const(5)
# layout: end
_FORMAT = const(1)
_AT_FORMAT = const(3)
_AT_VERSION = const(4)
_AT_SIZE = const(6)
_AT_SEQUENCE = const(8)
_AT_BINDING = const(12)
_HEADER = const(20)
_CRC = const(4)
# a record is read to be judged in pieces of so many bytes: a gap of the heap beside an open file
_PIECE = const(64)
_WHOLE = b"\x1c\xdf\x44\x21"  # what CRC-32 makes of anything that ends in its own CRC-32


class Store:
    """Payloads of size bytes in two slots of storage (see storage.py).

    binding is up to 8 bytes naming chip, range and filter (MPU6050.binding); version is that of
    the payload, 0..255. base is the first byte used, pitch the distance of the slots (an erase
    block of flash; default: no gap). payload is array('i') of size / 4 items, or bytearray (bytes
    to save) of size; goes_with, an array('i'), is written behind it, and not loaded. Where storage
    has read_pieces and write_pieces, as FileStorage has, saving makes no record.

    Raises ValueError for a binding, version, size or pitch that does not fit.
    """

    def __init__(
        self,
        storage: "Any",
        binding: bytes,
        size: int,
        version: int = 1,
        base: int = 0,
        pitch: int = 0,
        goes_with: "Any" = (),
    ) -> None:
        if len(binding) > 8 or not 0 < size < 65536 or not 0 <= version < 256:
            raise ValueError("at most: binding 8 bytes, size 65535, version 255")
        self._goes_with = goes_with
        self._all = size + 4 * len(goes_with)
        self.slot_bytes = slot_bytes(self._all)
        if pitch and pitch < self.slot_bytes:
            raise ValueError("a slot takes {} bytes, pitch is {}".format(self.slot_bytes, pitch))
        self.storage = storage
        self.binding = bytes(binding) + bytes(8 - len(binding))
        self.size = size
        self.version = version
        self.sequence = -1
        self.saves = 0
        self.failures = 0
        self._base = base
        self._pitch = pitch or self.slot_bytes
        self._header = bytearray(_HEADER)
        self._newest = -1

    def load(self, payload: "Any") -> int:
        """Fill payload from the newest whole slot that fits; LOADED, or why it is left as it was.

        A storage that reads otherwise once that slot was found leaves payload all 0, UNREADABLE.
        Never raises for what the storage holds or does. reasons.REASONS says each result in words.
        """
        self._require(payload)
        # read again straight into payload: a record beside it is more than a small heap has left
        piece = bytearray(_PIECE)
        slot = -1
        try:
            slot, reason = self._find(piece)
            if slot < 0:
                return reason
            if self._judge(slot, piece, payload) == _LOADED:
                return _LOADED
        except OSError:
            pass
        for i in range(len(payload) if slot >= 0 else 0):
            payload[i] = 0
        return _UNREADABLE

    def save(self, payload: "Any") -> bool:
        """Write payload to the older slot and read it back; False when that failed."""
        self._require(payload)
        try:
            # anew: was the newest damaged since, the older is all there is; no piece is held while
            # an open file takes heap of its own
            self._find(bytearray(_PIECE))
            slot = 1 if self._newest == 0 else 0
            sequence = self.sequence + 1
            self._write(slot, payload, sequence)
            written = self._judge(slot, bytearray(_PIECE)) == _LOADED
            written = written and self._sequence() == sequence
        except OSError:
            written = False
        if not written:
            self.failures += 1
            return False
        self._newest = slot
        self.sequence = sequence
        self.saves += 1
        return True

    def _require(self, payload):
        if len(payload) != self.size and len(payload) * 4 != self.size:
            raise ValueError("payload is of {} bytes".format(self.size))

    def _find(self, piece):
        """(slot to load or -1, reason); notes which slot is the newest whole one of any kind."""
        reason = _EMPTY
        whole = []
        for slot in range(2):
            judged = self._judge(slot, piece)
            if judged in (_EMPTY, _DAMAGED):
                reason = max(reason, judged)
            else:
                whole.append((self._sequence(), -slot, judged))  # of two alike the first
        whole.sort()
        self.sequence, newest, reason = whole[-1] if whole else (0, 1, reason)
        self._newest = -newest
        fits = [-slot for _, slot, judged in whole if judged == _LOADED]
        return fits[-1] if fits else -1, reason

    def _judge(self, slot, piece, payload=None):
        """Read slot through piece, a bytearray, its header to stay, and say what it is."""
        at = self._offset(slot)
        whole = self._is_whole(at, self.slot_bytes, piece, payload)
        header = self._header
        if header[:_AT_FORMAT] != b"ZRS":
            blank = header[0] in (0x00, 0xFF) and header[0] == header[1] == header[2]
            return _EMPTY if blank else _DAMAGED
        size = header[_AT_SIZE] | header[_AT_SIZE + 1] << 8
        if size != self._all:
            whole = slot_bytes(size) <= self._pitch and self._is_whole(at, slot_bytes(size), piece)
        if not whole:
            return _DAMAGED
        version = header[_AT_VERSION]
        if size != self._all:  # a record of another layout
            return _OTHER_VERSION if version != self.version else _OTHER_SIZE
        if header[_AT_FORMAT] != _FORMAT:
            return _OTHER_VERSION
        if header[_AT_BINDING:] != self.binding:
            return _OTHER_BINDING
        return _LOADED if version == self.version else _OTHER_VERSION

    def _is_whole(self, at, length, piece, payload=None):
        """Whether the record from at on is; its header is kept, and payload, if any, filled."""
        crc = bytearray(_CRC)
        at_payload = -_HEADER
        for part in self._pieces(at, length, piece):
            if at_payload < 0:
                self._header[:] = part[:_HEADER]
            checksum(part, crc)
            if payload is not None:
                unpack(part, at_payload, payload, self.size)
            at_payload += len(part)
        return crc == _WHOLE

    def _pieces(self, at, length, piece):
        if hasattr(self.storage, "read_pieces"):
            return self.storage.read_pieces(at, length, piece)
        return self._blocks(at, length, piece)

    def _blocks(self, at, length, piece):
        for done in range(0, length, len(piece)):
            part = memoryview(piece)[: length - done]
            self.storage.readblock(at + done, part)
            yield part

    def _sequence(self):
        at = _AT_SEQUENCE
        header = self._header
        return header[at] | header[at + 1] << 8 | header[at + 2] << 16 | header[at + 3] << 24

    def _offset(self, slot):
        return self._base + slot * self._pitch

    def _write(self, slot, payload, sequence):
        _tidy()
        header = (
            b"ZRS"
            + bytes(
                [_FORMAT, self.version, 0, self._all & 0xFF, self._all >> 8]
                + [sequence >> shift & 0xFF for shift in (0, 8, 16, 24)]
            )
            + self.binding
        )
        crc = bytearray(_CRC)
        parts = [header, packed(payload, self.size), crc]
        if self._goes_with:
            parts.insert(2, packed(self._goes_with, self._all - self.size))
        for part in parts[:-1]:
            checksum(part, crc)
        _tidy()
        if hasattr(self.storage, "write_pieces"):
            self.storage.write_pieces(self._offset(slot), parts)
        else:
            self.storage.writeblock(self._offset(slot), b"".join([bytes(part) for part in parts]))


def _tidy():
    """Let what is small take small gaps of the heap, and the file the long one."""
    if implementation.name == "micropython":
        gc.collect()


def slot_bytes(size):
    """Bytes of a slot for payloads of size bytes."""
    return _HEADER + size + _CRC


def packed(payload, size):
    """What has the bytes of payload, words little-endian whatever the machine."""
    if len(payload) == size or byteorder == "little":
        return payload
    return swapped(payload)


def swapped(words):
    """A copy of words with their bytes the other way round, which no board needs."""
    words = array("i", words)
    words.byteswap()
    return words


def unpack(part, at, payload, size):
    """Put what of part, a record's bytes from byte `at` of payload on, is payload's into it.

    size: payload's bytes; its words, if it is of such, are little-endian.
    """
    part = part[max(0, -at) : size - at] if at < size else b""
    at = max(0, at)
    if len(payload) == size:
        payload[at : at + len(part)] = part
        return
    words = array("i", bytes(part))
    if byteorder != "little":
        words = swapped(words)
    payload[at // 4 : at // 4 + len(words)] = words
