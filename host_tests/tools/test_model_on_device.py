"""The firmware takes the model that was made for it, and refuses any other by name."""

import struct
import zlib
from array import array
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from zerorate import Corrector, Sensor
from zerorate.effects import model_file
from zerorate.model import EffectModel
from zerorate_tools.errors import BadModel
from zerorate_tools.layout import EFFECTS
from zerorate_tools.model import Slot, build_model, decoded, encoded

from .test_model import BINDING, DEVICE, PLAY, SCALES, SLOTS


@pytest.fixture
def model():
    return build_model(SLOTS, SCALES, binding=BINDING)


def load(data, sensor=None, binding=DEVICE):
    return EffectModel().load(data, sensor or Sensor(), binding)


def test_the_firmware_takes_what_was_made_for_it(model):
    held = EffectModel()
    assert held.load(encoded(model), Sensor(), DEVICE) == model_file.LOADED
    assert held.channels == ("load", "vdd_mv")
    assert held.e[EFFECTS.SLOT_COUNT] == len(SLOTS)
    assert not held.channel("humidity", 3)


@pytest.mark.parametrize(
    ("sensor", "binding", "reason"),
    [
        (Sensor(), bytes([0x70, 0, 0, 3]), model_file.OTHER_CHIP),
        (Sensor(), bytes([0x68, 1, 0, 3]), model_file.OTHER_RANGE),
        (Sensor(), bytes([0x68, 0, 2, 3]), model_file.OTHER_RANGE),
        (Sensor(), bytes([0x68, 0, 0, 4]), model_file.OTHER_FILTER),
        (Sensor(gyro_lsb_per_dps=65.5), None, model_file.OTHER_RANGE),
        (Sensor(accel_lsb_per_g=8192.0), None, model_file.OTHER_RANGE),
        (Sensor(temp_lsb_per_degc=333.87), None, model_file.OTHER_SCALE),
        (Sensor(temp_offset_degc=21.0), None, model_file.OTHER_SCALE),
    ],
)
def test_the_firmware_refuses_another_device_by_name(model, sensor, binding, reason):
    assert load(encoded(model), sensor, binding) == reason
    assert len(model_file.REASONS) == 12


def test_what_both_know_of_a_binding_is_compared(model):
    for binding in (b"", DEVICE[:1], DEVICE + b"\x99"):
        assert load(encoded(model), binding=binding) == model_file.LOADED
    unknown = encoded(build_model(SLOTS, SCALES))
    assert load(unknown, binding=bytes([0x99, 1, 2, 6])) == model_file.LOADED


def test_bytes_that_no_tool_would_write_are_refused(model):
    data = bytearray(encoded(model))[:-4]
    data[11] = 1
    with pytest.raises(BadModel, match="do not belong together"):
        decoded(bytes(data) + struct.pack("<I", zlib.crc32(data)))


def test_play_operators_stand_behind_the_slots_and_make_another_version():
    plays = [Slot(PLAY, (0.001, 0, 0.002), "a"), Slot(replace(PLAY, power=2), (0, 0, 1e-5), "a")]
    model = build_model([*plays, *SLOTS], SCALES, binding=BINDING)
    assert model.slots == (*SLOTS, *plays)
    data = encoded(model)
    assert (data[3], encoded(build_model(SLOTS, SCALES, binding=BINDING))[3]) == (2, 1)
    assert load(data) == model_file.LOADED
    for bit in range(80, 88):
        turned = bytearray(data)
        turned[bit // 8] ^= 1 << bit % 8
        assert load(turned) == model_file.DAMAGED


def test_every_cut_and_every_turned_bit_is_refused(model):
    data = encoded(model)
    cuts = {load(data[:n]) for n in range(len(data))}
    assert cuts == {model_file.NO_MODEL, model_file.TRUNCATED}
    for n in range(len(data)):
        said = f"is cut short at byte {n}; copy it again" if n > 2 else "is no effect model"
        with pytest.raises(BadModel, match=said):
            decoded(data[:n])
        if n > 5:  # one that says itself to be so short
            said = "is cut short" if n < 64 else "is damaged: its checksum differs; copy it again"
            with pytest.raises(BadModel, match=said):
                decoded(data[:4] + n.to_bytes(2, "little") + data[6:n])
    seen = set()
    for bit in range(8 * len(data)):
        turned = bytearray(data)
        turned[bit // 8] ^= 1 << bit % 8
        seen.add(load(turned))
        if bit % 7 == 0:
            with pytest.raises(BadModel):
                decoded(bytes(turned))
    refused = {model_file.NO_MODEL, model_file.OTHER_VERSION, model_file.TRUNCATED}
    assert seen == refused | {model_file.DAMAGED}


@pytest.mark.parametrize("more", [b"\0", b"\0" * 40])
def test_a_model_longer_than_it_says_is_damaged_whatever_its_checksum(model, more):
    longer = encoded(model)[:-4] + more
    assert load(longer + zlib.crc32(longer).to_bytes(4, "little")) == model_file.DAMAGED


@given(noise=st.binary(max_size=300), at=st.integers(0, 1200))
@settings(max_examples=60, deadline=None)
def test_bytes_of_any_kind_with_a_right_checksum_never_raise(noise, at):
    data = bytearray(encoded(build_model(SLOTS, SCALES)))[:-4]
    data[at : at + len(noise)] = noise
    data[4:6] = struct.pack("<H", len(data) + 4)
    whole = bytes(data) + struct.pack("<I", zlib.crc32(data))
    assert 0 <= load(whole, binding=None) < len(model_file.REASONS)
    try:
        assert encoded(decoded(whole)) == whole
    except BadModel:
        pass


def test_a_file_that_is_not_there_is_a_reason_and_no_error(tmp_path):
    held = EffectModel()
    assert held.load_file(str(tmp_path / "none.bin"), Sensor()) == model_file.UNREADABLE
    assert held.e[EFFECTS.SLOT_COUNT] == 0


def test_a_refused_model_leaves_none(model):
    held = EffectModel()
    held.load(encoded(model), Sensor())
    held.load(encoded(model), Sensor(), bytes([1, 0, 0, 3]))
    assert held.e[EFFECTS.SLOT_COUNT] == 0


def test_a_device_whose_model_is_not_loaded_yet_or_no_longer_goes_on_without_effects(model):
    held, device, plain = EffectModel(), Corrector(), Corrector()
    device.use_model(held)

    def live():
        for _ in range(300):
            frames = [array("i", [0, 0, 16384, 0, 40, -20, 10]) for _ in range(2)]
            device.update(frames[0], 10_000)
            plain.update(frames[1], 10_000)
        return frames[0] == frames[1]

    assert live()
    held.load(encoded(model), device.sensor, DEVICE)
    assert not live()
    held.forget()
    assert live()
