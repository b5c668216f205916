"""Hours of sources for the effect slots: raw samples for the firmware, tick means for the float
reference, of the same columns."""

from array import array

import numpy as np
from scipy.signal import lfilter
from zerorate import Sensor
from zerorate.effects import effects
from zerorate.effects.model_file import LOADED, REASONS
from zerorate.model import EffectModel
from zerorate_tools.layout import STATE
from zerorate_tools.model import Binding, Slot, build_model, encoded
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales

SCALES = Scales("MPU-6050", 2.0, 131.0, 16384.0, 340.0, 36.53)
SENSOR = Sensor(2.0)
FRAME = ("ax", "ay", "az", "temp", "gx", "gy", "gz")
A_TICK = 2
HOURS = 2
_SAMPLES = HOURS * 3600 * A_TICK
TEMP = ("temp", 20.0, 45.0, 32.0)
TABLE = (0, 0.1, 0.3, 0.2, 0, -1, 1, 0.5, 0)
EVERY_SLOT = [
    Slot(Term(*TEMP, lag_mode="rate", lag_s=20.0), (0.3, -0.2, 0.1)),
    Slot(Term(*TEMP, lag_mode="lag", lag_s=300.0, power=3, decay_s=900.0), (1e-4, 2e-4, 0.0)),
    Slot(Term(*TEMP, memory="backlash", width=2.0, knot=0.3), (0.3, -0.2, 0.1)),
    Slot(Term(*TEMP, memory="peak", power=2), (0.01, -0.02, 0.005)),
    Slot(Term("rate_x", -200.0, 200.0, second="temp", second_lo=0, second_hi=60), (1e-3, 0, 1e-4)),
    Slot(Term("vib", 0.0, 0.2, table=TABLE), (1.0, -2.0, 3.0)),
    Slot(Term("vdd_mv", 4900.0, 5100.0, 5000.0, delay_s=90.0, power=2), (1e-4, 2e-5, 0.0)),
    Slot(Term("time", 0.0, 900.0), (1e-4, 2e-5, 0.0)),
]
PLAYS = [
    Slot(Term(*TEMP, memory="play", width=3.0), (0.01, -0.02, 0.005)),
    Slot(Term(*TEMP, power=2, memory="play", width=8.0), (0.001, -0.002, 0.0005)),
]


def columns(seed=1):
    """Raw columns at 2 Hz: warming, cooling, shaking, turning, a supply that sags, a load."""
    rng = np.random.default_rng(seed)
    t = np.arange(_SAMPLES) / A_TICK
    start, rise = rng.uniform(5, 30), rng.uniform(5, 25)
    temp = start + rise * (1 - np.exp(-t / rng.uniform(300, 2000)))
    temp += rng.uniform(1, 5) * np.sin(t / rng.uniform(200, 900)) + rng.normal(0, 0.02, _SAMPLES)
    shaken = 60 * (1 + 8 * (t % 700 > 400))
    found = {
        "ax": rng.normal(0, shaken) + 3000 * np.sin(t / 500),
        "ay": rng.normal(900, 60, _SAMPLES),
        "az": rng.normal(16384, shaken),
        "temp": (temp - SCALES.temp_offset_degc) * SCALES.temp_lsb_per_degc,
        "gx": 90 * 131 * np.sin(t / 7) + rng.normal(0, 6, _SAMPLES),
        "gy": rng.normal(300, 6, _SAMPLES),
        "gz": rng.normal(-90, 6, _SAMPLES),
        "vdd_mv": 5000 + 60 * np.sin(t / 300) - 5 * (t % 900 > 450),
        "pressure_pa": 101325 + 400 * np.sin(t / 1100),
    }
    return {name: np.round(values).astype(np.int64) for name, values in found.items()}


def tick_means(raw):
    """sources(name) -> (m,) as the float reference wants them."""
    accel = np.column_stack([raw[n] for n in FRAME[:3]]) / SCALES.accel_lsb_per_g
    slow, _ = lfilter([1 / 32], [1, -31 / 32], accel, axis=0, zi=31 / 32 * accel[:1])
    ticks = _SAMPLES // A_TICK
    samples = {
        "temp": SCALES.temp_degc(raw["temp"]),
        "vib": ((accel - slow) ** 2).sum(axis=1),
        **{f"acc_{a}": accel[:, i] for i, a in enumerate("xyz")},
        **{f"rate_{a}": raw[f"g{a}"] / SCALES.gyro_lsb_per_dps for a in "xyz"},
        **{n: raw[n].astype(float) for n in raw if n not in FRAME},
    }
    means = {n: v.reshape(ticks, A_TICK).mean(axis=1) for n, v in samples.items()}
    means["time"] = np.arange(ticks) + 0.5
    means["one"] = np.ones(ticks)
    return means.__getitem__


def last_samples(raw, ticks):
    """sources(name) at each tick's last sample but the first's: acceleration, rate and channels of
    that sample, else the mean of the tick before."""
    scales = {f"acc_{a}": (f"a{a}", 16384.0) for a in "xyz"}
    scales |= {f"rate_{a}": (f"g{a}", 131.0) for a in "xyz"}
    scales |= {name: (name, 1.0) for name in raw if name not in FRAME}

    def source(name):
        if name not in scales:
            return ticks(name)[:-1]
        column, lsb = scales[name]
        return raw[column][A_TICK - 1 :: A_TICK][1:] / lsb

    return source


def loaded(slots, scales=SCALES, sensor=SENSOR, tick_s=1.0):
    """An EffectModel with these slots, by way of the bytes of model.bin."""
    model = EffectModel()
    reason = model.load(encoded(build_model(slots, scales, tick_s=tick_s)), sensor)
    assert reason == LOADED, REASONS[reason]
    return model


def on_firmware(model, raw, dt_us=500000, good=lambda n: 1):
    """(n, 3) effects of every sample, dps."""
    state, frame = array("i", [0] * STATE.FIT_WEIGHTS), array("i", [0] * 7)
    rows = np.column_stack([raw[n] for n in FRAME]).tolist()
    channels = [raw[n].tolist() for n in model.channels]
    out = np.empty((len(rows), 3))
    for n, row in enumerate(rows):
        frame[:] = array("i", row)
        for i, values in enumerate(channels):
            model.channel(i, values[n])
        effects.sense(state, model.e, frame, dt_us, good(n))
        out[n] = state[STATE.EFFECT_Q8 : STATE.EFFECT_Q8 + 3]
    return out / 256 / SCALES.gyro_lsb_per_dps


def every_slot_bin():
    """The bytes of a model with a slot of each kind, and two play operators."""
    model = build_model([*EVERY_SLOT, *PLAYS], SCALES, binding=Binding(0x68, 0, 0, 3))
    return encoded(model)


def every_slot():
    """That model, loaded."""
    model = EffectModel()
    assert model.load(every_slot_bin(), Sensor(4.0)) == LOADED
    return model
