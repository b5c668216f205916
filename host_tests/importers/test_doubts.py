"""What cannot be true is refused and what hardly can is doubted, on both sides of each limit."""

import numpy as np
import pytest
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers.samples.counts import Counts

from .test_by_a_plain_reading import FORCE, PATH, imported


def a_rest(hz=100.0, n=1000, noise=0.05, unit="dps", **force):
    """White noise of so many dps, called so; a force that stands still."""
    rates = np.random.default_rng(1).normal(0.0, noise, (3, n))
    columns = {"t_s": np.arange(n) / hz, **dict(zip((f"g{a} ({unit})" for a in "xyz"), rates))}
    return columns | {name: np.full(n, force.get(name, 0.577)) for name in FORCE}


def said_of(columns, **options):
    """What an import doubts, or why it refuses."""
    try:
        return " ".join(imported(columns, **options)[2].doubts)
    except BadRecording as error:
        return str(error)


@pytest.mark.parametrize(
    ("noise", "unit", "hz", "swing", "shake", "told"),
    [
        # 0.1 dps a root of Hz are the loudest, and more is refused in rad/s alone
        *((0.78, "rad/s", 100, 0, 0, "mean dps"), (0.64, "rad/s", 100, 0, 0, "")),
        *((0.78, "dps", 100, 0, 0, ""), (0.25, "rad/s", 1, 0, 0, "mean dps")),
        (0.2, "rad/s", 1, 0, 0, ""),  # each row may be one reading of a faster sensor
        *((0.78, "rad/s", 100, 3.7, 0, "mean dps"), (0.78, "rad/s", 100, 4.3, 0, "")),  # moved
        *((0.78, "rad/s", 100, 0, 0.019, "mean dps"), (0.78, "rad/s", 100, 0, 0.021, "")),  # shaken
        # 0.2 mdps a root of Hz are the quietest, and less is refused in dps alone
        *((1.28e-3, "dps", 100, 0, 0, "mean rad/s"), (1.56e-3, "dps", 100, 0, 0, "")),
        *((1.28e-3, "rad/s", 100, 0, 0, ""), (0.0, "dps", 100, 0, 0, "")),
        *((2.8e-4, "dps", 5.1, 0, 0, "mean rad/s"), (2.8e-4, "dps", 4.9, 0, 0, "")),
    ],
)
def test_noise_that_no_sensor_has_at_rest_tells_another_unit(noise, unit, hz, swing, shake, told):
    columns, luck = a_rest(hz, noise=1.0, unit=unit), np.random.default_rng(2)
    for name in [*columns][1:4]:
        turn = swing * np.sin(np.arange(1000) / 40)
        columns[name] = (columns[name] + turn) * (noise / (57.29578 if unit == "rad/s" else 1.0))
    for name in FORCE:
        columns[name] = columns[name] + luck.normal(0.0, (shake or 0.004) / 0.954, 1000)
    said = said_of(columns)
    assert f"did you {told}" in said if told else not said


@pytest.mark.parametrize(
    ("g", "half", "hz", "told"),
    [
        *((0.81, 0.0, 100, ""), (0.79, 0.0, 100, "0.79 g, and gravity alone is 1 g; leave it")),
        *((1.24, 0.0, 100, ""), (1.26, 0.0, 100, "1.26 g"), (1.26, 0.0, 600, "")),  # under 2 s
        *((2.0, 0.11, 100, ""), (2.0, 0.09, 100, "2 g"), (0.5, 0.11, 100, "0.5 g")),  # shaken
        *((9.0, 0.0, 100, "did you mean m/s2?"), (11.7, 0.0, 100, "did you mean m/s2?")),
        *((12.1, 0.0, 100, "12.1 g, and gravity alone is 1 g; leave it out"),),
        *((7.8, 0.0, 100, "7.8 g, and gravity alone is 1 g; leave it"),),
    ],
)
def test_a_force_that_is_not_gravity_on_the_average_is_refused(g, half, hz, told):
    columns = a_rest(hz)
    size = g * (1 + half * np.linspace(-1.0, 1.0, 1000))
    columns |= {name: size / np.sqrt(3) for name in FORCE}
    said = said_of(columns)
    assert told in said and bool(told) is bool(said)


@pytest.mark.parametrize("lsb", [1024, 2048, 4096, 8192, 16384])
@pytest.mark.parametrize(("times", "told"), [(0.83, True), (1.19, True), (1.21, False)])
def test_counts_of_another_range_are_told_by_gravity(lsb, times, told):
    columns = a_rest()
    force = np.rint(lsb * times / np.sqrt(3)) + np.random.default_rng(1).integers(-1, 2, 1000)
    columns = {n.replace("_g", " [lsb]"): force if n in FORCE else v for n, v in columns.items()}
    said = said_of(columns, accel_lsb_per_g=32768.0)
    assert (f"give --accel-lsb-per-g {lsb}; else leave it out" in said) is told


@pytest.mark.parametrize(
    ("read", "told"),
    [
        *(([-59.0], ""), ([-61.0], "--map temp=temp_c:k"), ([129.0], ""), ([131.0], "131 degC")),
        *(([0.0], "0 throughout"), ([0.0, 0.5], "")),
        *((np.linspace(20, 30.7, 1000), "10.2 degC"), (np.linspace(20, 30.3, 1000), "")),
        (np.linspace(20, 30.7, 1000)[::-1], "10.2 degC"),
    ],
)
def test_a_temperature_that_no_sensor_has_is_doubted(read, told):
    said = said_of(a_rest() | {"temp_c": np.resize(read, 1000)})
    assert told in said and bool(told) is bool(said)


@pytest.mark.parametrize(
    ("changed", "hz", "counted", "told"),
    [
        *((3.3, 500.0, None, "give --hz, rows a second"), (2.9, 500.0, None, "")),
        *((3.3, 300.0, None, ""), (3.3, 500.0, 500.0, "give the true --hz")),
    ],
)
def test_three_degrees_are_no_noise_of_a_thermometer(changed, hz, counted, told):
    columns = a_rest(hz) | {"temp_c": np.linspace(20, 20 + changed, 1000)}
    said = said_of(columns, hz=counted)
    assert told in said and bool(told) is bool(said)


@pytest.mark.parametrize(("lost", "told"), [(51, "are dropped, and --hz counts"), (49, "")])
def test_many_dropped_rows_make_a_counted_time_doubtful(lost, told):
    columns = a_rest()
    columns["gx (dps)"][:lost] = np.nan
    said = said_of(columns, hz=100.0)
    assert said_of(columns) == "" and told in said and bool(told) is bool(said)


@pytest.mark.parametrize(
    ("counts", "said"),
    [
        *(([-32_768, 32_767], ""), ([0, 32_767], ""), ([0] * 99 + [32_768], "negative ones")),
        *(([0, 65_535], "negative ones"), ([0, 65_536], "0 to 65536 are no words of 16 bits")),
        *(([-1, 32_768], "are no words of 16 bits"), ([-32_769, 0], "-32769 to 0 are no words")),
        *(([0] * 98 + [65_000, 24_576], "negative ones"), ([0] * 98 + [24_576] * 2, "")),
        *(([0] * 97 + [65_000] + [24_576] * 2, "around 32768"),),
        *(([0] * 98 + [40_959] * 2, "around 32768"), ([0] * 98 + [40_960] * 2, "negative ones")),
        *(([0] * 97 + [65_000] + [24_575] * 2, "negative ones"), ([np.nan] * 9, "")),
    ],
)
@pytest.mark.parametrize("kind", ["gyro", "accel", "temp"])
def test_counts_are_words_of_16_bits_with_a_sign_or_without(kind, counts, said):
    name = {"gyro": "gy", "accel": "az", "temp": "temp"}[kind]
    seen, found = Counts(frozenset([kind])), []
    for part in np.split(np.array(counts, float), [len(counts) // 2]):
        columns = {name: part, "level": part.copy()}
        seen.signed(columns)
        found += columns[name].tolist()
    try:
        told = seen.notes(PATH)
    except BadRecording as error:
        told = [str(error)]
    assert said in "".join(told) and bool(told) is bool(said)
    signed = [n - 65_536 if 32_768 <= n < 65_536 else n for n in counts]
    assert np.array_equal(found, signed, equal_nan=True)
