"""A model's bytes, terms and words, by numbers worked out by hand or committed."""

import math
import zlib
from dataclasses import replace

import numpy as np
import pytest
from zerorate_tools.model import Binding, Slot, build_model, encoded
from zerorate_tools.model.effects import EFFECTS, is_free, table_of
from zerorate_tools.model.model import binding_of
from zerorate_tools.model.model_in_words import basis_in_words, differences, in_words
from zerorate_tools.model.term import Term, evaluate
from zerorate_tools.recordings import Scales

from .test_model import BINDING, PLAY, SCALES, SLOTS, TABLE

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


def test_a_grid_of_times_or_widths_doubles_and_kinks_are_a_tenth_of_the_range_apart():
    """So nothing between two values is far from both; a free curve and a rate need fewer."""
    for row in EFFECTS:
        for grid in (row.grids.get(name, ()) for name in ("lag_s", "width", "decay_s")):
            alike = 2 if row.source in ("temp", "one") else 4 if "rate" in row.kind else 3
            two_digits = [float(f"{grid[0] * alike**k:.2g}") for k in range(len(grid))]
            assert list(grid) == two_digits, row.kind
    (knots,) = (row.grids["knot"] for row in EFFECTS if "knot" in row.grids)
    assert knots == pytest.approx(np.arange(0.15, 0.9, 0.1))


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


def test_a_slot_in_words_says_each_of_its_steps():
    assert [basis_in_words(slot) for slot in (*EVERY, *FAST)] == [
        "temp less 32.5 degC, to the power of 2",
        "temp less 32.5 degC, its rate a second over 20 s",
        "1, fading from power-on with 240 s",
        "temp less 30 degC, through a table",
        "vib less 0.2 g^2, what is above 0.4 g^2",
        "acc_x less 0 g, backlash of 0.3 g",
        "temp less 30 degC, to the power of 3, less itself lagged by 90 s",
        "time less 0 s, the highest so far less itself, times (load less 0)",
        "temp less 32.5 degC, where a play operator of width 3 degC stands",
        "temp less 32.5 degC, where a play operator of width 3 degC stands, to the power of 2",
        "temp less 32.5 degC, where a play operator of width 6 degC stands",
        "rate_y less 0 dps",
        "acc_z less 0 g, times (vdd_mv less 0)",
        "load less 0, 700 s ago",
        "vdd_mv less 0, what is above 5",
        "load less 0, lagged by 30 s, fading from power-on with 60 s",
    ]


def test_a_model_in_words_says_for_what_it_is_and_where_each_slot_is_held():
    assert in_words(build_model(SLOTS[3:5], SCALES, binding=BINDING)).splitlines() == [
        "2 effect slots, 384 bytes, one tick in 1 s",
        "for MPU-6050 at 100 Hz, 131 LSB/dps; chip id 0x68, gyro range code 0, "
        "accel range code 0, filter code 3",
        "the application gives: load",
        "",
        "1. effect: temp less 30 degC, through a table",
        "   dps per unit, x y z: 0.1  0  0",
        "   held outside 20..45 degC",
        "   table: 0 0.25 0.5 0.7 1 0.5 0 -0.5 -1",
        "",
        "2. load: load less 100, 150 s ago, to the power of 2",
        "   dps per unit, x y z: 1e-06  2e-06  -1e-05",
        "   held outside 0..250",
    ]


def test_each_difference_of_two_models_is_a_line():
    one, other = (
        build_model(SLOTS[:n], SCALES, binding=b) for n, b in ((1, BINDING), (2, Binding()))
    )
    assert differences(one, other)[:2] == [
        "binding: chip_id: 104 and None",
        "binding: gyro_range: 0 and None",
    ]
    assert differences(one, other)[-1].startswith(
        "slot 2: only in the second: temp less 32.5 degC,"
    )
    assert differences(other, one)[-1].startswith("slot 2: only in the first: temp less 32.5 degC,")
    assert differences(one, replace(one, tick_us=5)) == ["tick_us: 1000000 and 5"]
