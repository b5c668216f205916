"""What was learned survives a power cut at any byte and any one bit turned, or is not believed."""

import struct
from array import array
from binascii import crc32
from pathlib import Path
from sys import byteorder

import pytest
from hypothesis import given
from hypothesis import strategies as st
from zerorate.storage import codes
from zerorate.storage import store as stores
from zerorate.storage.crc32 import checksum
from zerorate.storage.plain_crc32 import plain_crc32
from zerorate.storage.store import Store
from zerorate_fakes.memory import FakeMemory, FakeMemoryInPieces, PowerCut

BINDING = bytes([0x68, 0, 0, 3])
WORDS = 12
OLD = array("i", [7, -8, 2**29, -(2**30), 2**30 - 1, 0, -1, 5, 6, 7, 8, 9])
NEW = array("i", [-value // 3 for value in OLD])
BLANK = array("i", [99] * WORDS)


def make_store(memory, **options):
    return Store(memory, **{"binding": BINDING, "size": 4 * WORDS, **options})


def loaded(memory, **options):
    """(reason, payload) as after the next power-on."""
    payload = array("i", BLANK)
    return make_store(memory, **options).load(payload), payload


@pytest.fixture
def memory_of_two(memory):
    """Both slots whole: OLD, then NEW."""
    store = make_store(memory)
    assert store.save(OLD) and store.save(NEW)
    return memory


@pytest.mark.parametrize(
    ("kind", "torn_byte"),
    [(FakeMemory, torn) for torn in (None, 0x00, 0xFF, 0x5A)] + [(FakeMemoryInPieces, None)],
)
def test_power_cut_at_every_byte_of_every_write_loads_the_newest_whole(kind, torn_byte):
    memory = kind(4096)
    saved = [None, OLD, NEW, OLD, NEW]
    store = make_store(memory)
    for before, after in zip(saved, saved[1:], strict=False):
        image = bytes(memory.bytes)
        for cut in range(store.slot_bytes):
            memory.bytes[:] = image
            memory.cut_after, memory.torn_byte = cut, torn_byte
            with pytest.raises(PowerCut):
                make_store(memory).save(after)
            memory.cut_after = None
            reason, payload = loaded(memory)
            allowed = (
                (before, after)
                if torn_byte is not None and cut == store.slot_bytes - 1
                else (before,)
            )
            if reason == codes.LOADED:
                assert payload in allowed
            else:
                assert before is None and payload == BLANK
                assert reason in (codes.EMPTY, codes.DAMAGED)
        memory.bytes[:] = image
        memory.torn_byte = None
        assert make_store(memory).save(after)


def test_every_bit_turned_in_either_slot_loads_the_newest_whole(memory_of_two):
    slot_bits = 8 * make_store(memory_of_two).slot_bytes
    for bit in range(2 * slot_bits):
        memory_of_two.flip(bit)
        in_newest = bit >= slot_bits
        assert loaded(memory_of_two) == (codes.LOADED, OLD if in_newest else NEW), bit
        memory_of_two.flip(bit)


@pytest.mark.parametrize("cut_after", [0, 3, 30, 60])
def test_a_bit_turned_under_a_living_store_and_then_a_cut_cost_one_of_the_slots(
    memory_of_two, cut_after
):
    store, image = make_store(memory_of_two), bytes(memory_of_two.bytes)
    store.load(array("i", BLANK))
    for bit in range(16 * store.slot_bytes):
        memory_of_two.flip(bit)
        memory_of_two.cut_after = cut_after
        with pytest.raises(PowerCut):
            store.save(BLANK)
        reason, payload = loaded(memory_of_two)
        assert reason == codes.LOADED
        # what was written of the header may have mended the newest
        assert payload == NEW or (payload == OLD and bit >= 8 * store.slot_bytes), bit
        memory_of_two.cut_after, memory_of_two.bytes[:] = None, image


def test_a_storage_that_fails_is_a_reason_and_not_an_exception(memory_of_two):
    memory_of_two.broken = True
    assert loaded(memory_of_two) == (codes.UNREADABLE, BLANK)
    store = make_store(memory_of_two)
    assert not store.save(OLD)
    assert store.failures == 1


@pytest.mark.parametrize(
    "options",
    [
        {"binding": bytes(9)},
        {"size": 0},
        {"size": 65536},
        {"version": -1},
        {"version": 256},
        {"pitch": 1},
        {"pitch": 71},
        {"pitch": -1},
    ],
    ids=str,
)
def test_what_does_not_fit_is_a_value_error(memory, options):
    with pytest.raises(ValueError):
        make_store(memory, **options)


@pytest.mark.parametrize(("size", "version", "pitch"), [(1, 0, 0), (65535, 255, 65559)])
def test_the_ends_of_every_range_fit(size, version, pitch):
    memory, payload = FakeMemory(140000), bytearray(size)
    store = Store(memory, bytes(8), size, version, pitch=pitch)
    assert store.save(b"\xa5" * size) and store.save(b"\x5a" * size)
    assert store.load(payload) == codes.LOADED and payload == b"\x5a" * size
    assert (store.saves, store.failures) == (2, 0)


@pytest.mark.parametrize("length", [0, 1, 11, 13, 47, 49, 192])
def test_a_payload_of_another_length_is_a_value_error(memory, length):
    for use in (make_store(memory).save, make_store(memory).load):
        with pytest.raises(ValueError, match="48 bytes"):
            use(bytearray(length))


@given(st.binary(max_size=300))
def test_the_plain_checksum_is_the_interpreters(data):
    plain, own = bytearray(4), bytearray(4)
    plain_crc32(data, plain)
    checksum(data, own)
    assert plain == own == crc32(data).to_bytes(4, "little")


def test_cuts_and_turned_bits_end_alike_on_micropython_to_the_last_byte(micropython, find_runtime):
    root = Path(__file__).resolve().parents[2]
    script = Path(__file__).parent / "on_micropython" / "store_cut_and_turned.py"
    modules = [root / "firmware", root / "host_tests" / "fakes"]
    on_cpython = find_runtime("cpython").run(script, modules=modules, check=True).stdout
    assert micropython.run(script, modules=modules, check=True).stdout == on_cpython
    assert on_cpython.strip().endswith("2639f4cb")


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


@pytest.fixture(params=["little", "big"])
def held(request, monkeypatch):
    """held(words) -> the words as a machine of one byte order or the other has them in memory."""
    monkeypatch.setattr(stores, "byteorder", request.param)
    swaps = request.param != byteorder
    return lambda words: stores.swapped(words) if swaps else words


def test_the_first_record_has_sequence_one_and_words_are_little_endian(memory, held):
    store = make_store(memory, version=7)
    words = array(
        "i", [1, -1, -2, 0x12345678, -0x12345678, 2**29, -(2**30), 255, 256, 65535, 65536, -256]
    )
    assert store.save(held(words))
    little = b"".join(word.to_bytes(4, "little", signed=True) for word in words)
    assert memory.bytes[: store.slot_bytes] == record(little, version=7)
    assert loaded(memory, version=7) == (codes.LOADED, held(words))


def test_what_goes_with_the_words_is_little_endian_behind_them(memory, held):
    settings = array("i", [1, -1, 0x12345678])
    store = make_store(memory, goes_with=held(settings))
    assert store.save(held(OLD))
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
