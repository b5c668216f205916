"""model.json and model.bin are exact twins; their bytes, terms and words are as told by hand."""

import json
import math
import re
import zlib
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from zerorate import Sensor
from zerorate.effects import model_file
from zerorate.model import EffectModel
from zerorate_tools.cli import main
from zerorate_tools.errors import BadModel
from zerorate_tools.layout import SLOT, slot_at
from zerorate_tools.model import (
    Binding,
    CannotDeploy,
    Slot,
    build_model,
    decoded,
    encoded,
    from_json,
    to_json,
    write_model,
)
from zerorate_tools.model.effects import is_free, table_of
from zerorate_tools.model.model import binding_of
from zerorate_tools.model.model_in_words import differences
from zerorate_tools.model.term import Term, evaluate
from zerorate_tools.recordings import Scales

SCALES = Scales("MPU-6050", 100.0, 131.0, 16384.0, 340.0, 36.53)
BINDING = Binding(0x68, 0, 0, 3)
TABLE = (0, 0.25, 0.5, 0.7, 1, 0.5, 0, -0.5, -1)
SLOTS = [
    Slot(Term("temp", 20, 45, 32.5, power=2), (0.001, -0.002, 0.0003), "temperature-quadratic"),
    Slot(Term("temp", 20, 45, 32.5, lag_mode="rate", lag_s=20), (0.3, -0.2, 0.1), "thermal-rate"),
    Slot(Term("one", decay_s=240), (0.05, 0.1, -0.1), "power-on-transient"),
    Slot(Term("temp", 20, 45, 30, table=TABLE), (0.1, 0, 0)),
    Slot(Term("load", 0, 250, 100, delay_s=150, power=2), (1e-6, 2e-6, -1e-5), "load"),
    Slot(Term("vdd_mv", 4900, 5100, 5000, second="temp", second_lo=20, second_hi=45), (1e-5,) * 3),
]

PLAY = Term("temp", 20, 45, 32.5, memory="play", width=3)


@pytest.fixture
def model():
    return build_model(SLOTS, SCALES, binding=BINDING)


@pytest.fixture
def files(model, tmp_path):
    return write_model(model, tmp_path)


def finite(lo, hi):
    return st.floats(lo, hi, allow_nan=False, allow_subnormal=False)


@st.composite
def any_slot(draw):
    source = draw(st.sampled_from(["temp", "acc_x", "vib", "time", "one", "vdd_mv", "rate_z"]))
    largest = {"temp": 80, "acc_x": 2, "vib": 4, "time": 90000, "rate_z": 250}.get(source, 1e6)
    lo, hi = sorted(draw(st.tuples(finite(-largest, largest), finite(-largest, largest))))
    lo, hi = lo + 0.0, hi + 0.0  # no negative zero
    fields = {} if source == "one" else {"lo": lo, "hi": hi, "centre": draw(finite(lo, hi))}
    remembers = draw(st.sampled_from(["", "lag", "difference", "rate", "backlash", "peak"]))
    if remembers in ("lag", "difference", "rate"):
        fields.update(lag_mode=remembers, lag_s=draw(finite(8, 7200)))
    elif remembers:
        fields.update(memory=remembers, width=draw(finite(0, largest)))
    if draw(st.booleans()):
        fields.update(knot=draw(finite(-largest / 4, largest / 4)))
    if draw(st.booleans()):
        fields.update(decay_s=draw(finite(40, 14400)))
    if draw(st.booleans()):
        fields.update(second="temp", second_lo=0.0, second_hi=60.0, second_centre=30.1)
    fields.update(power=draw(st.integers(1, 3)), power_first=draw(st.booleans()))
    if source == "temp" and draw(st.booleans()):
        kept = {name: fields[name] for name in ("lo", "hi", "centre")}
        width, power = draw(finite(0, largest)), draw(st.integers(1, 2))
        fields = {**kept, "memory": "play", "width": width, "power": power}
    coefficients = draw(st.tuples(*[finite(-1e-3, 1e-3)] * 3))
    return Slot(Term(source, **fields), coefficients, draw(st.sampled_from(["", "kink", "\u00e9"])))


@given(slots=st.lists(any_slot(), max_size=8), gyro=finite(10.0, 2000.0), tick_s=finite(0.5, 20.0))
@settings(max_examples=60, deadline=None)
def test_json_and_bytes_are_exact_twins_of_any_model(slots, gyro, tick_s):
    try:
        model = build_model(slots, replace(SCALES, gyro_lsb_per_dps=gyro), tick_s=tick_s)
    except CannotDeploy:
        return
    data = encoded(model)
    assert decoded(data) == model
    assert from_json(to_json(model)) == model
    assert encoded(from_json(to_json(decoded(data)))) == data
    sensor = Sensor(100.0, gyro)
    assert EffectModel().load(data, sensor) == model_file.LOADED


@pytest.mark.parametrize("tick_s", [0.0, 0.009, 537.0])
def test_a_tick_that_no_board_has_is_refused(tick_s):
    with pytest.raises(CannotDeploy, match="0.01..536 s are possible"):
        build_model([], SCALES, tick_s=tick_s)


def test_what_is_built_differs_from_what_was_wanted_by_rounding_alone():
    wanted = Slot(Term("temp", 20.123456, 45, 32.5, lag_mode="lag", lag_s=123.456789), (1 / 3,) * 3)
    built = build_model([wanted], SCALES).slots[0]
    assert built.term.lo == pytest.approx(20.123456, abs=1e-5)
    assert built.term.lag_s == pytest.approx(123.456789, rel=3e-5)
    assert built.coefficient_dps == pytest.approx((1 / 3,) * 3, rel=2e-6)


@pytest.mark.parametrize(
    ("slots", "why"),
    [
        ([SLOTS[0]] * 9, "room for 8 effect slots"),
        ([SLOTS[4]] * 3, "room for 2 delays"),
        ([SLOTS[3]] * 3, "room for 2 tables"),
        ([replace(SLOTS[3], term=replace(SLOTS[3].term, table=(2.0,) * 9))], "within -1..1"),
        ([Slot(Term("temp", lag_mode="lag", lag_s=1e9), (1e-3,) * 3)], "too long"),
        ([Slot(Term("temp", delay_s=1e6), (1e-3,) * 3)], "delay_s of 1e.06 s is too long"),
        ([Slot(Term("x", lag_mode="lag", lag_s=9, memory="peak"), (1e-6,) * 3)], "both a lag"),
        ([Slot(Term("x", power=0.5), (1e-6,) * 3)], "power 0.5"),
        ([Slot(PLAY, (1e-3,) * 3)] * 2, "twice"),
        *(
            ([Slot(replace(PLAY, **more), (1e-3,) * 3)], "itself and its square, nothing else")
            for more in ({"power": 3}, {"decay_s": 9}, {"table": TABLE})
        ),
        ([Slot(Term("one", memory="play"), (1, 0, 0))], "constant does nothing"),
        ([Slot(Term("temp", 20, 45, 20), (2000, 0, 0))], "could move the rate by 96376 dps"),
        ([Slot(replace(PLAY, width=w), (1e-3,) * 3) for w in range(7)], "room for 6 play"),
    ],
)
def test_what_does_not_fit_the_slots_says_so(slots, why):
    with pytest.raises(CannotDeploy, match=why):
        build_model(slots, SCALES)


def test_a_source_without_a_scale_says_so():
    with pytest.raises(CannotDeploy, match="scales have none"):
        build_model(SLOTS[:1], Scales("G", 100.0, 131.0))


def broken_json(model, **changes):
    values = json.loads(to_json(model))
    for path, value in changes.items():
        *parents, last = path.split("__")
        at = values
        for parent in parents:
            at = at[int(parent) if parent.isdigit() else parent]
        at[int(last) if last.isdigit() else last] = value
    return json.dumps(values)


@pytest.mark.parametrize(
    ("changes", "where"),
    [
        ({"format": "png"}, "no effect model"),
        ({"version": 2}, "version 2"),
        ({"tick_us": "soon"}, "tick_us"),
        ({"tick_us": 0}, "tick_us: 0 us"),
        ({"tick_us": 1 << 29}, "tick_us: 536870912 us; 10000 to 536870911 are"),
        ({"scales__gyro_lsb_per_dps": -1}, "scales"),
        ({"binding__chip_id": 4000}, "binding"),
        ({"inputs__0__shift": -9}, "inputs: shift -9"),
        ({"inputs__0__shift": 16}, "inputs: shift 16"),
        ({"inputs__0__offset": 1 << 29}, "or offset 536870912"),
        ({"slots__1__lag_mode": "sideways"}, "slot 2: lag_mode"),
        ({"slots__0__coefficient_dps": [1, 2]}, "slot 1: coefficient_dps"),
        ({"slots__2__decay_s": -5}, "slot 3: decay_s"),
        ({"slots__0__power": 7}, "slot 1: power"),
        ({"inputs": 7}, "inputs is not as `zerorate close` writes it"),
        ({"binding": [1]}, "binding is not as `zerorate close` writes it"),
        ({"scales": None}, "scales is not as `zerorate close` writes it"),
    ],
)
def test_a_wrong_entry_is_named(model, changes, where):
    with pytest.raises(BadModel, match=where):
        from_json(broken_json(model, **changes))


@pytest.mark.parametrize("shift", [-8, 15])
def test_an_input_is_shifted_by_a_byte_down_and_two_up_at_most(model, shift):
    assert from_json(broken_json(model, inputs__0__shift=shift)).inputs[0].shift == shift


@pytest.mark.parametrize("text", ['["\\ud800"]', "9" * 5000, "[" * 100_000, "{", b"\xff"], ids=len)
def test_what_is_no_json_is_said_in_one_line(text):
    with pytest.raises(
        BadModel, match="model.json: is no JSON .*correct the text there"
    ) as refused:
        from_json(text)
    assert "\n" not in str(refused.value) and str(refused.value).isascii()


def test_check_asks_the_firmware(files, capsys):
    assert main(["model", "check", str(files[1]), "--chip-id", "0x68"]) == 0
    assert main(["model", "check", str(files[0]), "--chip-id", "0x70"]) == 2
    assert "model.json: refused by the firmware: the model was made for another chip" in (
        capsys.readouterr().err
    )
    text = files[0].read_text()
    alone = files[0].with_name("alone.json")
    alone.write_text(re.sub(r'("odr_hz": )[0-9.]+', r"\g<1>9000", text))
    assert main(["model", "check", str(alone)]) == 2
    assert "alone.json: no firmware has such scales: odr_hz must be" in capsys.readouterr().err


def test_check_finds_a_twin_that_is_none(files, model, capsys):
    other = replace(model, slots=model.slots[:2])
    files[1].write_bytes(encoded(build_model(other.slots, SCALES, binding=BINDING)))
    assert main(["model", "check", str(files[0])]) == 2
    assert "not the twin of model.bin" in capsys.readouterr().err


def test_diff_says_what_differs_and_only_that(files, model, tmp_path, capsys):
    assert main(["model", "diff", *map(str, files)]) == 0
    assert "the same to the last bit" in capsys.readouterr().out
    changed = replace(SLOTS[0], coefficient_dps=(0.001, -0.0021, 0.0003))
    other = build_model([changed, *SLOTS[1:]], SCALES, binding=BINDING)
    (tmp_path / "b").mkdir()
    write_model(other, tmp_path / "b")
    assert main(["model", "diff", str(files[0]), str(tmp_path / "b" / "model.bin")]) == 1
    assert differences(model, other) == capsys.readouterr().out.splitlines()
    assert len(differences(model, other)) == 1
    assert "-0.002, 0.0003) and (0.001, -0.0021" in differences(model, other)[0]


def test_every_table_and_delay_goes_with_its_own_slot():
    tables = TABLE, tuple(-v for v in TABLE)
    slots = [Slot(Term("temp", 20, 45, 30, table=table), (0.1, 0, 0)) for table in tables]
    slots.insert(1, Slot(Term("load", -1, 1), (0.1, 0, 0)))
    slots += [Slot(Term("load", -1, 1, delay_s=s), (0.1, 0, 0)) for s in (7.0, 20.0)]
    read = decoded(encoded(build_model(slots, SCALES)))
    assert [slot.term.delay_s for slot in read.slots] == [0, 0, 0, 7.0, 20.0]
    for slot, own in zip(read.slots, slots):
        assert (slot.term.table is None) == (own.term.table is None)
        assert slot.term.table is None or slot.term.table == pytest.approx(own.term.table, abs=1e-6)
    model = EffectModel()
    assert model.load(encoded(build_model(slots, SCALES)), Sensor()) == model_file.LOADED
    at = [model.e[slot_at(n) + SLOT.SLOT_TABLE] for n in (0, 2)]
    assert at[1] - at[0] == len(TABLE)


def test_a_name_has_at_most_63_bytes():
    long = replace(SCALES, sensor="x" * 63)
    assert decoded(encoded(build_model([], long))).scales.sensor == "x" * 63
    for more in ("x", "xx"):
        with pytest.raises(CannotDeploy, match="longer than 63 bytes"):
            build_model([], replace(long, sensor=long.sensor + more))


EVERY = [
    *SLOTS[:4],
    Slot(Term("vib", 0, 1.5, 0.2, knot=0.4), (0.1, 0, 0)),
    Slot(Term("acc_x", -1, 1, memory="backlash", width=0.3), (0.1, -0.2, 0)),
    Slot(Term("temp", 20, 45, 30, power=3, power_first=True, lag_mode="difference", lag_s=90),
         (1e-5, 0, 2e-5)),
    Slot(Term("time", 0, 900, memory="peak", second="load", second_lo=-9, second_hi=9),
         (1e-6, 0, 0)),
    Slot(PLAY, (0.02, -0.01, 0.005), "hysteresis"),
    Slot(replace(PLAY, power=2), (0.001, 0.002, 0), "hysteresis"),
    Slot(replace(PLAY, width=6.0), (0.01, 0, 0), "hysteresis"),
]  # fmt: skip
FAST = [
    Slot(Term("rate_y", -250, 250), (0.01, 0, 0)),
    Slot(Term("acc_z", -2, 2, second="vdd_mv", second_lo=3000, second_hi=3600), (1e-5, 0, 0)),
    Slot(Term("load", 0, 9, delay_s=700), (0.01, 0, 0)),
    Slot(Term("vdd_mv", knot=5.0), (1e-8, 0, 0)),
    Slot(Term("load", 0, 9, lag_mode="lag", lag_s=30, decay_s=60), (0.01, 0, 0)),
]


@pytest.mark.parametrize(
    ("slots", "tick_s", "size", "crc"),
    [(EVERY, 1.0, 1331, 1404085548), (FAST, 2.0, 738, 202663907), (SLOTS, 0.5, 950, 686748055)],
)
def test_a_model_has_the_bytes_that_boards_already_read(slots, tick_s, size, crc):
    data = encoded(build_model(slots, SCALES, binding=BINDING, tick_s=tick_s))
    assert (len(data), zlib.crc32(data[:-4])) == (size, crc)


RISE = np.array([20.0, 24.0, 30.0, 26.0, 25.0])
LAG = 1 - math.exp(-2 / 10)


@pytest.mark.parametrize(
    ("fields", "expected"),
    [
        ({"lo": 22, "hi": 28, "centre": 25, "power": 3}, [-27, -1, 27, 1, 0]),
        ({"knot": 3.0}, [0, 1, 7, 3, 2]),
        ({"lag_mode": "difference", "lag_s": 10.0}, [0, 4 * (1 - LAG)]),
        ({"lag_mode": "rate", "lag_s": 10.0}, [0, 0.4 * (1 - LAG)]),
        ({"lag_mode": "lag", "lag_s": 10.0, "power": 2, "power_first": True}, [0, 16 * LAG]),
        ({"memory": "play", "width": 6.0}, [0, 1, 7, 7, 7]),
        ({"memory": "backlash", "width": 6.0}, [0, -3, -3, 1, 2]),
        ({"memory": "peak"}, [0, 0, 0, 4, 5]),
        ({"delay_s": 5.0}, [0, 0, 0, 4, 10]),
        ({"second": "load", "second_lo": 1, "second_hi": 3, "second_centre": 0.5}, [0, 2, 15, 15]),
        ({"decay_s": 8.0}, [0, *(v * math.exp(-k / 4) for k, v in enumerate([4, 10, 6, 5], 1))]),
        ({"hi": 40, "lo": 20, "table": TABLE}, [0, 0.4, 1, 0.58, 0.5]),
        ({"hi": 40, "lo": 20, "table": TABLE, "power": 2}, [0, 0.4, 1, 0.58, 0.5]),
    ],
)
def test_a_term_is_what_its_fields_say(fields, expected):
    of = {"temp": RISE, "time": 2.0 * np.arange(5) + 1, "load": np.array([0.0, 1.0, 2.0, 9.0, 9.0])}
    term = Term("temp", **{"lo": 20, "hi": 50, "centre": 20, **fields})
    assert evaluate(term, of.__getitem__, 2.0)[: len(expected)] == pytest.approx(expected)


@pytest.mark.parametrize("code", range(4))
def test_a_range_is_known_by_its_scale_to_a_thousandth(code):
    gyro, accel = (131.0, 65.5, 32.8, 16.4)[code], 16384.0 / 2**code
    for off, known in ((0.9995, True), (1.0005, True), (0.998, False), (1.002, False)):
        found = binding_of(Scales("MPU-6050", 100.0, gyro * off, accel * off))
        assert found.gyro_range == (code if known else None)
        assert found.accel_range == (code if known else None)


def test_a_table_reaches_from_minus_one_to_one_and_is_free_unless_a_row_has_it():
    assert table_of(lambda v: 3 * v, 10, 18) == pytest.approx(np.linspace(-1, 1, 9))
    assert math.isnan(table_of(lambda v: 0 * v, 0, 1)[0])
    assert is_free(Term("load", 0, 1, table=TABLE)) and not is_free(Term("load", 0, 1))
