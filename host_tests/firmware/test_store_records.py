"""What a slot holds, to the byte: which of two is loaded, which is written, and what is said."""

import struct
from array import array
from binascii import crc32

import pytest
from zerorate.storage import codes
from zerorate.storage import store as stores
from zerorate.storage.store import Store
from zerorate_fakes.memory import FakeMemory

from .test_store import BINDING, BLANK, NEW, OLD, WORDS, loaded, make_store


def record(payload=OLD, sequence=1, version=1, form=1, binding=BINDING, size=None):
    """A whole record, by the words of store.py."""
    payload = bytes(payload)
    size = len(payload) if size is None else size
    head = b"ZRS" + struct.pack("<BBBHI8s", form, version, 0, size, sequence, binding)
    return head + payload + crc32(head + payload).to_bytes(4, "little")


def image(*slots, pitch=4 * WORDS + 24):
    """A memory of these slots."""
    memory = FakeMemory(4096)
    for number, slot in enumerate(slots):
        memory.bytes[number * pitch : number * pitch + len(slot)] = slot
    return memory


@pytest.mark.parametrize("size", [1, 5, 48, 300, 600])
@pytest.mark.parametrize("sequence", [0, 1, 0xFE, 0x01020304, 0x7FFFFFFE])
def test_a_record_is_as_it_is_documented_to_the_byte(size, sequence):
    before, after = (bytes((3 * i + add) & 0xFF for i in range(size)) for add in (1, 2))
    memory = image(record(before, sequence), pitch=1024)
    store = Store(memory, BINDING, size, pitch=1024)
    assert (store.sequence, store.saves, store.failures) == (-1, 0, 0)
    assert store.slot_bytes == size + 24
    assert store.save(after)
    assert memory.bytes[:1024].rstrip(b"\xff") == record(before, sequence).rstrip(b"\xff")
    assert memory.bytes[1024 : 1024 + size + 24] == record(after, sequence + 1)
    assert (store.sequence, store.saves, store.failures) == (sequence + 1, 1, 0)
    assert memory.written == size + 24


@pytest.mark.parametrize("byteorder", ["little", "big"])
def test_the_first_record_has_sequence_one_and_words_are_little_endian(
    memory, monkeypatch, byteorder
):
    monkeypatch.setattr(stores, "byteorder", byteorder)
    store = make_store(memory, version=7)
    words = array(
        "i", [1, -1, -2, 0x12345678, -0x12345678, 2**29, -(2**30), 255, 256, 65535, 65536, -256]
    )
    assert store.save(words)
    little = b"".join(word.to_bytes(4, "little", signed=True) for word in words)
    assert memory.bytes[: store.slot_bytes] == record(little, version=7)
    assert loaded(memory, version=7) == (codes.LOADED, words)


@pytest.mark.parametrize("byteorder", ["little", "big"])
def test_what_goes_with_the_words_is_little_endian_behind_them(memory, monkeypatch, byteorder):
    monkeypatch.setattr(stores, "byteorder", byteorder)
    settings = array("i", [1, -1, 0x12345678])
    store = make_store(memory, goes_with=settings)
    assert store.save(OLD)
    assert memory.bytes[: store.slot_bytes] == record(OLD.tobytes() + settings.tobytes())


BAD = bytes([0x5A]) * 72
ZEROS, ONES = bytes(72), b"\xff" * 72
OTHER = {
    "chip": record(NEW, 9, binding=b"\x70"),
    "version": record(NEW, 9, version=2),
    "form": record(NEW, 9, form=2),
}


@pytest.mark.parametrize(
    ("slots", "reason", "payload"),
    [
        ((ZEROS, ONES), codes.EMPTY, BLANK),
        ((ZEROS, ZEROS), codes.EMPTY, BLANK),
        ((ONES, ONES), codes.EMPTY, BLANK),
        ((ONES, BAD), codes.DAMAGED, BLANK),
        ((BAD, ONES), codes.DAMAGED, BLANK),
        ((b"\x00\x00\xff" + ONES[3:], ONES), codes.DAMAGED, BLANK),
        ((b"\x00\xff\xff" + ONES[3:], ONES), codes.DAMAGED, BLANK),
        ((b"\xff\x00\x00" + ZEROS[3:], ONES), codes.DAMAGED, BLANK),
        ((b"\x00\xff\x00" + ONES[3:], ONES), codes.DAMAGED, BLANK),
        ((b"\xff\xff\x00" + ONES[3:], ONES), codes.DAMAGED, BLANK),
        ((b"\xff\x00\xff" + ONES[3:], ONES), codes.DAMAGED, BLANK),
        ((b"\x01\x01\x01" + ONES[3:], ONES), codes.DAMAGED, BLANK),
        ((b"\xfe\xfe\xfe" + ONES[3:], ONES), codes.DAMAGED, BLANK),
        ((b"\x00\x00\x00" + ONES[3:], ONES), codes.EMPTY, BLANK),
        ((record(OLD, 1), record(NEW, 2)), codes.LOADED, NEW),
        ((record(NEW, 2), record(OLD, 1)), codes.LOADED, NEW),
        ((record(OLD, 0), ONES), codes.LOADED, OLD),
        ((ONES, record(OLD, 0)), codes.LOADED, OLD),
        ((record(OLD, 5), record(NEW, 5)), codes.LOADED, OLD),
        ((record(OLD, 0xFF), record(NEW, 0x100)), codes.LOADED, NEW),
        ((record(OLD, 0xFF00), record(NEW, 0x10000)), codes.LOADED, NEW),
        ((record(OLD, 0xFF0000), record(NEW, 0x1000000)), codes.LOADED, NEW),
        ((record(OLD, 1), OTHER["chip"]), codes.LOADED, OLD),
        ((OTHER["version"], record(OLD, 10)), codes.LOADED, OLD),
        ((OTHER["chip"], BAD), codes.OTHER_BINDING, BLANK),
        ((BAD, OTHER["chip"]), codes.OTHER_BINDING, BLANK),
        ((OTHER["version"], record(NEW, 8, binding=b"\x70")), codes.OTHER_VERSION, BLANK),
        ((OTHER["version"], record(NEW, 10, binding=b"\x70")), codes.OTHER_BINDING, BLANK),
        ((record(NEW, 8, binding=b"\x70"), OTHER["form"]), codes.OTHER_VERSION, BLANK),
        ((OTHER["form"], ONES), codes.OTHER_VERSION, BLANK),
        ((record(OLD)[:-1] + b"\x00", ONES), codes.DAMAGED, BLANK),
    ],
)  # fmt: skip
def test_of_two_slots_the_newest_that_fits_is_loaded_or_it_is_said_why_not(slots, reason, payload):
    assert loaded(image(*slots)) == (reason, payload)


@pytest.mark.parametrize(
    ("slots", "written"),
    [
        ((ONES, ONES), 0),
        ((record(OLD, 1), ONES), 1),
        ((ONES, record(OLD, 1)), 0),
        ((record(OLD, 1), record(NEW, 2)), 0),
        ((record(NEW, 2), record(OLD, 1)), 1),
        ((record(NEW, 5), record(NEW, 5)), 1),
        ((record(OLD, 1), OTHER["chip"]), 0),
        ((OTHER["chip"], record(OLD, 1)), 1),
    ],
)
def test_a_save_goes_to_the_slot_that_is_not_the_newest(slots, written):
    memory = image(*slots)
    before = bytes(memory.bytes)
    assert make_store(memory).save(OLD)
    changed = {at // 72 for at in range(144) if memory.bytes[at] != before[at]}
    assert changed == {written}
    assert loaded(memory) == (codes.LOADED, OLD)


@pytest.mark.parametrize(
    ("size", "version", "reason"),
    [
        (20, 1, codes.OTHER_SIZE),
        (20, 2, codes.OTHER_VERSION),
        (0x12C, 1, codes.OTHER_SIZE),
        (512 - 24, 1, codes.OTHER_SIZE),
        (512 - 23, 1, codes.DAMAGED),
    ],
)
def test_a_whole_record_of_another_size_is_known_up_to_the_pitch(size, version, reason):
    other = record(bytes(range(256)) * 2, version=version)
    other = record(other[20 : 20 + size], version=version)
    assert loaded(image(other, pitch=512), pitch=512) == (reason, BLANK)
    other = other[:-1] + bytes([other[-1] ^ 1])
    assert loaded(image(other, pitch=512), pitch=512) == (codes.DAMAGED, BLANK)


@pytest.mark.parametrize("slots", [(), (record(OLD, 1),), (record(OLD, 1), record(NEW, 2))])
def test_a_write_that_does_not_stick_is_a_failed_save(slots):
    memory = image(*slots)
    memory.writeblock = lambda offset, buf: None
    store = make_store(memory)
    assert store.save(OLD) is False and store.save(OLD) is False
    assert (store.saves, store.failures) == (0, 2)
