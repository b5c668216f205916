"""Learned state kept over a power cut: two slots, the newest whole one counts.

A record is  "ZRS" format version size sequence binding payload crc32  with little-endian numbers
(1, 1, 2, 4, 8 bytes) and CRC-32 of all before it. A save writes the slot that does not hold the
newest whole record, so until the last byte stands the one before it is whole.
"""

from .crc32 import checksum

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

const = int  # on a board the compiler itself reads const(...)

try:
    from sys import byteorder

    from uctypes import addressof, bytearray_at

    if byteorder != "little":
        raise ImportError
except ImportError:
    bytearray_at = None  # type: ignore[assignment]

_FORMAT = const(1)
_AT_FORMAT = const(3)
_AT_VERSION = const(4)
_AT_SIZE = const(6)
_AT_SEQUENCE = const(8)
_AT_BINDING = const(12)
_HEADER = const(20)
_CRC = const(4)

# layout: What a store says
LOADED = const(0)
EMPTY = const(1)
DAMAGED = const(2)
OTHER_BINDING = const(3)
OTHER_VERSION = const(4)
OTHER_SIZE = const(5)
UNREADABLE = const(6)
# layout: What a store says, in words
REASONS = (
    "loaded",
    "nothing was ever stored",
    "neither slot is whole",
    "stored for another chip, range or filter",
    "stored by another version",
    "stored with another size",
    "the storage cannot be read",
)
# layout: end


class Store:
    """Payloads of size bytes in two slots of storage (see storage.py).

    binding is up to 8 bytes naming chip, range and filter (MPU6050.binding); version is that of
    the payload, 0..255, and older the versions of the same size that load takes besides. base is
    the first byte used, pitch the distance of the slots (an erase block of flash; default: no
    gap). payload is array('i') of size / 4 items, or bytearray (bytes to save) of size.

    Raises ValueError for a binding, version, size or pitch that does not fit.
    """

    def __init__(
        self,
        storage: "Any",
        binding: bytes,
        size: int,
        version: int = 1,
        older: "Sequence[int]" = (),
        base: int = 0,
        pitch: int = 0,
    ) -> None:
        if len(binding) > 8 or not 0 < size < 65536 or not 0 <= version < 256:
            raise ValueError("binding is of 8 bytes at most, size of 1..65535, version of 0..255")
        self.slot_bytes = slot_bytes(size)
        if 0 < pitch < self.slot_bytes:
            raise ValueError("a slot takes {} bytes, pitch is {}".format(self.slot_bytes, pitch))
        self.storage = storage
        self.binding = bytes(binding) + bytes(8 - len(binding))
        self.size = size
        self.version = version
        self.loaded_version = -1
        self.sequence = -1
        self.saves = 0
        self.failures = 0
        self._older = older
        self._base = base
        self._pitch = pitch or self.slot_bytes
        self._record = bytearray(self.slot_bytes)
        self._crc = bytearray(_CRC)
        self._newest = -1

    def load(self, payload: "Any") -> int:
        """Fill payload from the newest whole slot that fits; LOADED, or why it is left as it was.

        Never raises for what the storage holds or does. REASONS says each result in words.
        """
        self._require(payload)
        try:
            slot, reason = self._find()
            if slot < 0:
                return reason
            if self._judge(slot) != LOADED:
                return UNREADABLE
        except OSError:
            return UNREADABLE
        self.loaded_version = self._record[_AT_VERSION]
        unpack(self._record, _HEADER, payload, self.size)
        return LOADED

    def save(self, payload: "Any") -> bool:
        """Write payload to the older slot and read it back; False when that failed."""
        self._require(payload)
        try:
            self._find()  # anew: where the newest was damaged since, the older is all there is
            slot = 1 if self._newest == 0 else 0
            sequence = self.sequence + 1
            self._compose(payload, sequence)
            self.storage.writeblock(self._offset(slot), self._record)
            written = self._judge(slot) == LOADED and self._sequence() == sequence
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

    def _find(self):
        """(slot to load or -1, reason); notes which slot is the newest whole one of any kind."""
        best = -1
        best_sequence = -1
        reason = EMPTY
        self._newest = -1
        self.sequence = 0
        newest_reason = EMPTY
        for slot in range(2):
            judged = self._judge(slot)
            if judged in (EMPTY, DAMAGED):
                reason = max(reason, judged)
                continue
            sequence = self._sequence()
            if self._newest < 0 or sequence > self.sequence:
                self._newest = slot
                self.sequence = sequence
                newest_reason = judged
            if judged == LOADED and sequence > best_sequence:
                best = slot
                best_sequence = sequence
        return best, newest_reason if self._newest >= 0 else reason

    def _judge(self, slot):
        """Read slot into the record and say what it is."""
        record = self._record
        self.storage.readblock(self._offset(slot), record)
        if record[:_AT_FORMAT] != b"ZRS":
            blank = record[0] in (0x00, 0xFF) and record[0] == record[1] == record[2]
            return EMPTY if blank else DAMAGED
        size = record[_AT_SIZE] | record[_AT_SIZE + 1] << 8
        if size != self.size:
            return self._judge_other_size(slot, size)
        if not self._is_whole(record, size):
            return DAMAGED
        if record[_AT_FORMAT] != _FORMAT:
            return OTHER_VERSION
        if record[_AT_BINDING:_HEADER] != self.binding:
            return OTHER_BINDING
        version = record[_AT_VERSION]
        return LOADED if version == self.version or version in self._older else OTHER_VERSION

    def _judge_other_size(self, slot, size):
        """A record of another layout is told from a damaged one by its own checksum."""
        if _HEADER + size + _CRC > self._pitch:
            return DAMAGED
        other = bytearray(_HEADER + size + _CRC)
        self.storage.readblock(self._offset(slot), other)
        if not self._is_whole(other, size):
            return DAMAGED
        return OTHER_VERSION if other[_AT_VERSION] != self.version else OTHER_SIZE

    def _is_whole(self, record, size):
        checksum(record, _HEADER + size, self._crc)
        return record[_HEADER + size :] == self._crc

    def _sequence(self):
        at = _AT_SEQUENCE
        record = self._record
        return record[at] | record[at + 1] << 8 | record[at + 2] << 16 | record[at + 3] << 24

    def _offset(self, slot):
        return self._base + slot * self._pitch

    def _compose(self, payload, sequence):
        record = self._record
        record[:_HEADER] = (
            b"ZRS"
            + bytes(
                [_FORMAT, self.version, 0, self.size & 0xFF, self.size >> 8]
                + [sequence >> shift & 0xFF for shift in (0, 8, 16, 24)]
            )
            + self.binding
        )
        pack(payload, record, _HEADER, self.size)
        checksum(record, _HEADER + self.size, self._crc)
        record[_HEADER + self.size :] = self._crc


def slot_bytes(size):
    """Bytes of a slot for payloads of size bytes."""
    return _HEADER + size + _CRC


def pack(payload, record, at, size):
    """Payload into record from at on, words little-endian whatever the machine."""
    if len(payload) == size:
        record[at : at + size] = payload
        return
    if bytearray_at is not None:  # word by word takes the time of five samples
        record[at : at + size] = bytearray_at(addressof(payload), size)
        return
    for word in payload:
        record[at] = word & 0xFF
        record[at + 1] = word >> 8 & 0xFF
        record[at + 2] = word >> 16 & 0xFF
        record[at + 3] = word >> 24 & 0xFF
        at += 4


def unpack(record, at, payload, size):
    """The reverse of pack."""
    if len(payload) == size:
        payload[:] = record[at : at + size]
        return
    if bytearray_at is not None:
        bytearray_at(addressof(payload), size)[:] = memoryview(record)[at : at + size]
        return
    for i in range(len(payload)):
        top = record[at + 3]
        word = record[at] | record[at + 1] << 8 | record[at + 2] << 16
        payload[i] = word | (top - ((top & 0x80) << 1)) << 24
        at += 4
