"""What was learned survives a power cut at any byte and any one bit turned, or is not believed."""

import os
import struct
from array import array
from binascii import crc32
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from zerorate import Corrector, Sensor, layout
from zerorate.storage import store as stores
from zerorate.storage.crc32 import checksum, plain_crc32
from zerorate.storage.places import BlockDeviceStorage, FileStorage
from zerorate.storage.save_schedule import SaveSchedule
from zerorate.storage.store import Store
from zerorate_fakes.memory import FakeMemory, PowerCut

BINDING = bytes([0x68, 0, 0, 3])
WORDS = 12
OLD = array("i", [7, -8, 2**29, -(2**30), 2**30 - 1, 0, -1, 5, 6, 7, 8, 9])
NEW = array("i", [-value // 3 for value in OLD])
BLANK = array("i", [99] * WORDS)


def make_store(memory, **options):
    return Store(memory, options.pop("binding", BINDING), 4 * WORDS, **options)


def loaded(memory, **options):
    """(reason, payload) as after the next power-on."""
    payload = array("i", BLANK)
    return make_store(memory, **options).load(payload), payload


@pytest.fixture
def memory():
    return FakeMemory(4096)


@pytest.fixture
def memory_of_two(memory):
    """Both slots whole: OLD, then NEW."""
    store = make_store(memory)
    assert store.save(OLD) and store.save(NEW)
    return memory


def test_what_is_saved_is_loaded(memory):
    assert make_store(memory).save(OLD)
    assert loaded(memory) == (stores.LOADED, OLD)


def test_plain_bytes_are_stored_as_they_are(memory):
    store = Store(memory, BINDING, 5)
    assert store.save(b"\x00\xff\x80\x01\x7f")
    payload = bytearray(5)
    for reader in (store, Store(memory, BINDING, 5)):
        assert reader.load(payload) == stores.LOADED
        assert payload == b"\x00\xff\x80\x01\x7f"
    assert set(memory.bytes[store.slot_bytes :]) == {0xFF}


@pytest.mark.parametrize("erased", [0x00, 0xFF])
def test_a_memory_never_written_is_empty_and_leaves_the_payload(erased):
    assert loaded(FakeMemory(4096, erased)) == (stores.EMPTY, BLANK)


def test_saves_go_to_the_slots_in_turn(memory):
    store = make_store(memory)
    slots = []
    for payload in (OLD, NEW, OLD, NEW):
        before = bytes(memory.bytes)
        store.save(payload)
        changed = [i for i in range(len(before)) if memory.bytes[i] != before[i]]
        slots.append({i // store.slot_bytes for i in changed})
    assert slots == [{0}, {1}, {0}, {1}]


def test_nothing_is_written_outside_the_two_slots(memory):
    store = make_store(memory, base=100)
    for _ in range(4):
        store.save(NEW)
    assert set(memory.bytes[:100]) == {0xFF}
    assert set(memory.bytes[100 + 2 * store.slot_bytes :]) == {0xFF}


@pytest.mark.parametrize("torn_byte", [None, 0x00, 0xFF, 0x5A])
def test_power_cut_at_every_byte_of_every_write_loads_the_newest_whole(memory, torn_byte):
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
            if reason == stores.LOADED:
                assert payload in allowed
            else:
                assert before is None and payload == BLANK
                assert reason in (stores.EMPTY, stores.DAMAGED)
        memory.bytes[:] = image
        memory.torn_byte = None
        assert make_store(memory).save(after)


def test_after_a_power_cut_the_next_save_spares_the_whole_slot(memory_of_two):
    memory_of_two.cut_after = 10
    with pytest.raises(PowerCut):
        make_store(memory_of_two).save(OLD)
    memory_of_two.cut_after = 10
    with pytest.raises(PowerCut):
        make_store(memory_of_two).save(OLD)
    memory_of_two.cut_after = None
    assert loaded(memory_of_two) == (stores.LOADED, NEW)


def test_every_bit_turned_in_either_slot_loads_the_newest_whole(memory_of_two):
    slot_bits = 8 * make_store(memory_of_two).slot_bytes
    for bit in range(2 * slot_bits):
        memory_of_two.flip(bit)
        in_newest = bit >= slot_bits
        assert loaded(memory_of_two) == (stores.LOADED, OLD if in_newest else NEW), bit
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
        assert reason == stores.LOADED
        # what was written of the header may have mended the newest
        assert payload == NEW or (payload == OLD and bit >= 8 * store.slot_bytes), bit
        memory_of_two.cut_after, memory_of_two.bytes[:] = None, image


def test_a_bit_turned_in_both_slots_is_a_clean_start(memory_of_two):
    slot_bits = 8 * make_store(memory_of_two).slot_bytes
    for bit in range(slot_bits):
        memory_of_two.flip(bit)
        memory_of_two.flip(slot_bits + (bit * 7 + 3) % slot_bits)
        assert loaded(memory_of_two) == (stores.DAMAGED, BLANK)
        memory_of_two.flip(bit)
        memory_of_two.flip(slot_bits + (bit * 7 + 3) % slot_bits)


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
    assert (store.sequence, store.loaded_version, store.saves, store.failures) == (-1, -1, 0, 0)
    assert store.slot_bytes == size + 24
    assert store.save(after)
    assert memory.bytes[:1024].rstrip(b"\xff") == record(before, sequence).rstrip(b"\xff")
    assert memory.bytes[1024 : 1024 + size + 24] == record(after, sequence + 1)
    assert (store.sequence, store.saves, store.failures) == (sequence + 1, 1, 0)
    assert memory.written == size + 24


@pytest.mark.parametrize("in_one_piece", [False, True])
def test_the_first_record_has_sequence_one_and_words_are_little_endian(
    memory, monkeypatch, in_one_piece
):
    if in_one_piece:  # as uctypes gives them on MicroPython
        monkeypatch.setattr(stores, "addressof", memoryview, raising=False)
        whole = lambda words, size: words.cast("B")[:size]  # noqa: E731
        monkeypatch.setattr(stores, "bytearray_at", whole)
    store = make_store(memory, version=7)
    words = array(
        "i", [1, -1, -2, 0x12345678, -0x12345678, 2**29, -(2**30), 255, 256, 65535, 65536, -256]
    )
    assert store.save(words)
    little = b"".join(word.to_bytes(4, "little", signed=True) for word in words)
    assert memory.bytes[: store.slot_bytes] == record(little, version=7)
    assert loaded(memory, version=7) == (stores.LOADED, words)


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
        ((ZEROS, ONES), stores.EMPTY, BLANK),
        ((ONES, BAD), stores.DAMAGED, BLANK),
        ((BAD, ONES), stores.DAMAGED, BLANK),
        ((b"\x00\x00\xff" + ONES[3:], ONES), stores.DAMAGED, BLANK),
        ((b"\x00\xff\xff" + ONES[3:], ONES), stores.DAMAGED, BLANK),
        ((b"\xff\x00\x00" + ZEROS[3:], ONES), stores.DAMAGED, BLANK),
        ((b"\x00\xff\x00" + ONES[3:], ONES), stores.DAMAGED, BLANK),
        ((b"\xff\xff\x00" + ONES[3:], ONES), stores.DAMAGED, BLANK),
        ((b"\xff\x00\xff" + ONES[3:], ONES), stores.DAMAGED, BLANK),
        ((b"\x01\x01\x01" + ONES[3:], ONES), stores.DAMAGED, BLANK),
        ((b"\xfe\xfe\xfe" + ONES[3:], ONES), stores.DAMAGED, BLANK),
        ((b"\x00\x00\x00" + ONES[3:], ONES), stores.EMPTY, BLANK),
        ((record(OLD, 1), record(NEW, 2)), stores.LOADED, NEW),
        ((record(NEW, 2), record(OLD, 1)), stores.LOADED, NEW),
        ((record(OLD, 0), ONES), stores.LOADED, OLD),
        ((ONES, record(OLD, 0)), stores.LOADED, OLD),
        ((record(OLD, 5), record(NEW, 5)), stores.LOADED, OLD),
        ((record(OLD, 0xFF), record(NEW, 0x100)), stores.LOADED, NEW),
        ((record(OLD, 0xFF00), record(NEW, 0x10000)), stores.LOADED, NEW),
        ((record(OLD, 0xFF0000), record(NEW, 0x1000000)), stores.LOADED, NEW),
        ((record(OLD, 1), OTHER["chip"]), stores.LOADED, OLD),
        ((OTHER["version"], record(OLD, 10)), stores.LOADED, OLD),
        ((OTHER["chip"], BAD), stores.OTHER_BINDING, BLANK),
        ((BAD, OTHER["chip"]), stores.OTHER_BINDING, BLANK),
        ((OTHER["version"], record(NEW, 8, binding=b"\x70")), stores.OTHER_VERSION, BLANK),
        ((OTHER["version"], record(NEW, 10, binding=b"\x70")), stores.OTHER_BINDING, BLANK),
        ((record(NEW, 8, binding=b"\x70"), OTHER["form"]), stores.OTHER_VERSION, BLANK),
        ((OTHER["form"], ONES), stores.OTHER_VERSION, BLANK),
        ((record(OLD)[:-1] + b"\x00", ONES), stores.DAMAGED, BLANK),
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
    assert loaded(memory) == (stores.LOADED, OLD)


@pytest.mark.parametrize(
    ("size", "version", "reason"),
    [
        (20, 1, stores.OTHER_SIZE),
        (20, 2, stores.OTHER_VERSION),
        (0x12C, 1, stores.OTHER_SIZE),
        (512 - 24, 1, stores.OTHER_SIZE),
        (512 - 23, 1, stores.DAMAGED),
    ],
)
def test_a_whole_record_of_another_size_is_known_up_to_the_pitch(size, version, reason):
    other = record(bytes(range(256)) * 2, version=version)
    other = record(other[20 : 20 + size], version=version)
    assert loaded(image(other, pitch=512), pitch=512) == (reason, BLANK)
    other = other[:-1] + bytes([other[-1] ^ 1])
    assert loaded(image(other, pitch=512), pitch=512) == (stores.DAMAGED, BLANK)


@given(noise=st.binary(min_size=200, max_size=200))
def test_noise_is_never_loaded_and_never_raises(noise):
    memory = FakeMemory(4096)
    memory.bytes[:200] = noise
    reason, payload = loaded(memory)
    assert reason != stores.LOADED and payload == BLANK


@pytest.mark.parametrize("binding", [bytes([0x70, 0, 0, 3]), bytes([0x68, 1, 0, 3]), bytes([0x68])])
def test_another_chip_range_or_filter_is_refused_by_name(memory_of_two, binding):
    reason, payload = loaded(memory_of_two, binding=binding)
    assert reason == stores.OTHER_BINDING and payload == BLANK
    assert "another chip" in stores.REASONS[reason]


def test_a_chip_that_comes_back_finds_its_own_slot(memory_of_two):
    assert make_store(memory_of_two, binding=b"\x70").save(OLD)
    assert loaded(memory_of_two) == (stores.LOADED, NEW)


def test_an_older_version_loads_where_it_is_taken_and_says_which(memory):
    make_store(memory, version=3).save(OLD)
    store = make_store(memory, version=4, older=(2, 3))
    payload = array("i", BLANK)
    assert store.load(payload) == stores.LOADED
    assert (payload, store.loaded_version) == (OLD, 3)


def test_an_older_version_is_else_refused_by_name(memory):
    make_store(memory, version=3).save(OLD)
    reason, payload = loaded(memory, version=4)
    assert (reason, payload) == (stores.OTHER_VERSION, BLANK)
    assert "version" in stores.REASONS[reason]


def test_a_record_of_another_size_is_refused_by_name(memory):
    Store(memory, BINDING, 20, pitch=512).save(bytes(20))
    assert loaded(memory, pitch=512) == (stores.OTHER_SIZE, BLANK)


def test_a_storage_that_fails_is_a_reason_and_not_an_exception(memory_of_two):
    memory_of_two.broken = True
    assert loaded(memory_of_two) == (stores.UNREADABLE, BLANK)
    store = make_store(memory_of_two)
    assert not store.save(OLD)
    assert store.failures == 1


@pytest.mark.parametrize("slots", [(), (record(OLD, 1),), (record(OLD, 1), record(NEW, 2))])
def test_a_write_that_does_not_stick_is_a_failed_save(slots):
    memory = image(*slots)
    memory.writeblock = lambda offset, buf: None
    store = make_store(memory)
    assert store.save(OLD) is False and store.save(OLD) is False
    assert (store.saves, store.failures) == (0, 2)


def test_a_storage_that_reads_another_thing_each_time_cannot_be_read(memory_of_two):
    reads, readblock = [], memory_of_two.readblock

    def read(offset, buf):
        readblock(offset, buf)
        reads.append(offset)
        buf[30] ^= len(reads) > 2

    memory_of_two.readblock = read
    assert loaded(memory_of_two) == (stores.UNREADABLE, BLANK)


def test_every_reason_has_words():
    assert len(stores.REASONS) == stores.UNREADABLE + 1


@pytest.mark.parametrize(
    "options",
    [{"binding": bytes(9)}, {"version": -1}, {"version": 256}, {"pitch": 1}, {"pitch": 71}],
    ids=str,
)
def test_what_does_not_fit_is_a_value_error(memory, options):
    with pytest.raises(ValueError):
        make_store(memory, **options)


@pytest.mark.parametrize("size", [0, 65536])
def test_a_size_that_does_not_fit_is_a_value_error(memory, size):
    with pytest.raises(ValueError):
        Store(memory, BINDING, size)


@pytest.mark.parametrize(("size", "version", "pitch"), [(1, 0, 0), (65535, 255, 65559)])
def test_the_ends_of_every_range_fit(size, version, pitch):
    memory, payload = FakeMemory(140000), bytearray(size)
    store = Store(memory, bytes(8), size, version, pitch=pitch)
    assert store.save(b"\xa5" * size) and store.save(b"\x5a" * size)
    assert store.load(payload) == stores.LOADED and payload == b"\x5a" * size
    assert (store.loaded_version, store.saves, store.failures) == (version, 2, 0)


@pytest.mark.parametrize("length", [0, 1, 11, 13, 47, 49, 192])
def test_a_payload_of_another_length_is_a_value_error(memory, length):
    for use in (make_store(memory).save, make_store(memory).load):
        with pytest.raises(ValueError, match="48 bytes"):
            use(bytearray(length))


class TestFile:
    @pytest.fixture
    def path(self, tmp_path):
        return tmp_path / "learned.bin"

    def test_what_is_saved_is_loaded(self, path):
        for payload in (OLD, NEW, OLD):
            assert make_store(FileStorage(path)).save(payload)
        assert loaded(FileStorage(path)) == (stores.LOADED, OLD)

    def test_a_missing_file_is_empty(self, path):
        assert loaded(FileStorage(path)) == (stores.EMPTY, BLANK)

    def test_a_file_cut_short_at_any_byte_is_never_wrong(self, path):
        store = make_store(FileStorage(path))
        store.save(OLD)
        store.save(NEW)
        whole = path.read_bytes()
        for length in range(len(whole)):
            path.write_bytes(whole[:length])
            reason, payload = loaded(FileStorage(path))
            if length >= store.slot_bytes:
                assert (reason, payload) == (stores.LOADED, OLD)
            else:
                assert reason in (stores.EMPTY, stores.DAMAGED) and payload == BLANK

    def test_a_folder_in_its_place_is_a_reason(self, tmp_path):
        assert loaded(FileStorage(tmp_path)) == (stores.UNREADABLE, BLANK)
        assert not make_store(FileStorage(tmp_path)).save(OLD)

    @pytest.mark.parametrize(
        ("offset", "length", "read"),
        [
            (0, 4, b"0123"),
            (7, 3, b"789"),
            (7, 6, b"789\xff\xff\xff"),
            (10, 2, b"\xff\xff"),
            (50, 1, b"\xff"),
        ],
    )
    def test_what_is_beyond_the_end_reads_as_erased(self, path, offset, length, read):
        path.write_bytes(b"0123456789")
        buf = bytearray(b"U" * length)
        FileStorage(path).readblock(offset, buf)
        assert buf == read
        FileStorage(path.with_name("missing")).readblock(offset, buf)
        assert buf == b"\xff" * length

    @pytest.mark.parametrize("synced", [True, False])
    def test_what_is_written_is_there_and_what_was_there_stays(self, path, monkeypatch, synced):
        told = []
        if synced:
            monkeypatch.setattr(os, "fsync", lambda number: told.append(path.read_bytes()))
        else:
            monkeypatch.delattr(os, "fsync")
        storage, writes = FileStorage(path), [(5, b"abc"), (0, b"xy"), (6, b"BCD"), (20, b"!")]
        for offset, data in writes:
            storage.writeblock(offset, data)
        there = [
            b"\xff\xff\xff\xff\xffabc",
            b"xy\xff\xff\xffabc",
            b"xy\xff\xff\xffaBCD",
            b"xy\xff\xff\xffaBCD" + bytes(11) + b"!",
        ]
        assert path.read_bytes() == there[-1]
        assert told == (there if synced else [])


class FakeFlash:
    """A block device whose writes can only clear bits of what was erased."""

    BLOCK = 256

    def __init__(self, blocks):
        self.bytes = bytearray(self.BLOCK * blocks)
        self.erased = []

    def readblocks(self, block, buf, offset):
        start = block * self.BLOCK + offset
        buf[:] = self.bytes[start : start + len(buf)]

    def writeblocks(self, block, buf, offset):
        start = block * self.BLOCK + offset
        for i, byte in enumerate(buf):
            self.bytes[start + i] &= byte

    def ioctl(self, operation, block):
        assert operation == 6
        self.erased.append(block)
        start = block * self.BLOCK
        self.bytes[start : start + self.BLOCK] = b"\xff" * self.BLOCK


def test_on_flash_each_slot_has_an_erase_block_of_its_own():
    flash = FakeFlash(8)
    for payload in (OLD, NEW, OLD):
        storage = BlockDeviceStorage(flash, 5, FakeFlash.BLOCK)
        assert make_store(storage, pitch=FakeFlash.BLOCK).save(payload)
    storage = BlockDeviceStorage(flash, 5, FakeFlash.BLOCK)
    assert loaded(storage, pitch=FakeFlash.BLOCK) == (stores.LOADED, OLD)
    assert flash.erased == [5, 6, 5]


@pytest.mark.parametrize(
    ("offset", "length", "erased"),
    [
        (0, 1, [5]),
        (0, 256, [5]),
        (0, 257, [5, 6]),
        (255, 1, [5]),
        (255, 2, [5, 6]),
        (256, 256, [6]),
        (300, 10, [6]),
        (100, 600, [5, 6, 7]),
        (513, 255, [7]),
    ],
)
def test_every_block_that_is_written_is_erased_first_and_no_other(offset, length, erased):
    flash = FakeFlash(9)
    storage = BlockDeviceStorage(flash, 5, FakeFlash.BLOCK)
    data = bytes(i % 251 for i in range(length))
    storage.writeblock(offset, data)
    assert flash.erased == erased
    at = 5 * 256 + offset
    assert flash.bytes[at : at + length] == data
    assert set(flash.bytes[5 * 256 : at]) <= {0xFF, 0} and not any(flash.bytes[: 5 * 256])
    buf = bytearray(length)
    storage.readblock(offset, buf)
    assert buf == data


@given(st.binary(max_size=300))
def test_the_plain_checksum_is_the_interpreters(data):
    plain, own = bytearray(4), bytearray(4)
    plain_crc32(data, len(data), plain)
    checksum(data, len(data), own)
    assert plain == own == crc32(data).to_bytes(4, "little")


class TestSavingAtRest:
    @pytest.fixture
    def corrector(self):
        return Corrector(Sensor(odr_hz=100.0))

    @pytest.fixture
    def schedule(self, memory, corrector):
        return SaveSchedule(make_store(memory), 3, tolerance=10, corrector=corrector)

    def test_a_save_waits_for_a_rest(self, schedule, corrector):
        assert not schedule.offer(OLD, [0, -10, 0], 0)
        corrector.state[layout.STATE.STILLNESS] = layout.STILLNESS.STILL
        assert schedule.offer(OLD, [0, -10, 0], 1)
        assert schedule.postponed == 1

    def test_but_no_longer_than_a_write_s_share_of_a_day(self, schedule):
        assert not schedule.offer(OLD, [0, -10, 0], 10)
        assert not schedule.offer(OLD, [0, -10, 0], 3609)
        assert schedule.offer(OLD, [0, -10, 0], 3610)

    def test_what_saving_costs_is_told(self, schedule, corrector):
        assert "Nothing was saved yet" in corrector.explain()
        corrector.state[layout.STATE.STILLNESS] = layout.STILLNESS.STILL
        schedule.offer(OLD, [0, -10, 0], 0)
        schedule.longest_us = 97_400
        told = "Saved 1 times, for 97 ms at the longest: 10 samples pass, which a FIFO keeps"
        assert told in corrector.explain()


class TestSchedule:
    @pytest.fixture
    def schedule(self, memory):
        return SaveSchedule(make_store(memory), 3, tolerance=10, writes_a_day=24)

    def test_what_changed_little_is_not_written(self, schedule):
        assert not schedule.offer(OLD, [9, -9, 0], 0)

    def test_what_changed_by_the_tolerance_is(self, schedule):
        assert schedule.offer(OLD, [0, -10, 0], 0)

    def test_what_was_loaded_needs_no_writing(self, schedule):
        schedule.loaded([1000, 2000, 3000])
        assert not schedule.offer(OLD, [1001, 2001, 2999], 5)

    def test_a_day_of_wild_changes_stays_within_the_budget(self, schedule, memory):
        for second in range(0, 86400, 7):
            schedule.offer(OLD, [second * 50, 0, 0], second)
        assert schedule.store.saves == 24
        assert memory.written == 24 * schedule.store.slot_bytes
        assert schedule.postponed > 0

    def test_a_failed_write_also_counts_against_the_budget(self, schedule, memory):
        memory.broken = True
        assert [schedule.offer(OLD, [100, 0, 0], second) for second in range(100)] == [False] * 100
        assert schedule.store.failures == 1


def test_cuts_and_turned_bits_end_alike_on_micropython_to_the_last_byte(micropython, find_runtime):
    root = Path(__file__).resolve().parents[2]
    script = Path(__file__).parent / "on_micropython" / "store_cut_and_turned.py"
    modules = [root / "firmware", root / "host_tests" / "fakes"]
    on_cpython = find_runtime("cpython").run(script, modules=modules, check=True).stdout
    assert micropython.run(script, modules=modules, check=True).stdout == on_cpython
    assert on_cpython.strip().endswith("2639f4cb")
