"""Devices of which one power-on is recorded, or two: what is drawn of them, from a seed."""

import numpy as np

#: A step has an RMS about the mean of 3 floors, half its jump, as every effect's size is its RMS;
#: a small one a jump of 3 floors.
KINDS = ("nothing", "step", "shock", "hysteresis", "lag", "kink", "small step")
_FLOOR_DPS, _JUMP_FLOORS = 0.002, {"step": 6.0, "small step": 3.0}
_REST = {"kind": "rest", "s": [90, 150]}
_HAND = {"kind": "hand", "s": [8, 16]}
_SHOCK = {"kind": "vibration", "g": 4.0, "s": 2}
#: Temperature by name: to degC, a minute.
_PATHS = {
    "slow": [{"to": 45.0, "minutes": 32}, {"minutes": 4}, {"to": 24.0, "minutes": 34}],
    "fast": [
        {"to": 50.0, "minutes": 5},
        {"minutes": 20},
        {"to": 20.0, "minutes": 7},
        {"minutes": 18},
        {"to": 40.0, "minutes": 5},
        {"minutes": 10},
    ],
    "warm-up": [{"to": 41.0, "tau_s": 900, "minutes": 60}],
}


def describe(seed: int) -> tuple[dict, str, int]:
    """(description, kind, recordings that are closed); one more power-on follows them."""
    rng = np.random.default_rng(7_000_000 + seed)
    kind, recordings = KINDS[seed % len(KINDS)], 1 if rng.random() < 0.6 else 2
    path = _PATHS[str(rng.choice(list(_PATHS)))]
    motion: list[dict] = [_REST, _HAND] if rng.random() < 0.5 else []
    if kind == "shock" or (kind in _JUMP_FLOORS and rng.random() < 0.5):
        motion = [{"kind": "rest", "s": [500, 900]}, _SHOCK, *motion]
    size = float(np.exp(rng.uniform(np.log(2.0), np.log(20.0)))) * _FLOOR_DPS
    described = {
        "sensor": {
            "odr_hz": 4.0,
            "gyro_noise_at_hz": 100.0,
            "temp_step_lsb": float(rng.choice([1.0, 32.0, 170.0])),
        },
        "bias": {
            "b0": list(rng.normal(0, 0.8, 3)),
            "b1": list(rng.normal(0, 0.015, 3)),
            "b2": list(rng.normal(0, 2e-4, 3) * (rng.random() < 0.5)),
            "turn_on_dps": 0.02,
        },
        "noise": {"bias_instability_dps": _FLOOR_DPS, "random_walk_dps": 5e-5},
        "sessions": recordings + 1,
        "every_session": {
            "start_degc": 22.0,
            "vary_degc": 2.0,
            "vary_time": 0.15,
            "temperature": path,
            "motion": motion,
        },
        "effect": _effects(rng, kind, size, recordings),
    }
    return described, kind, recordings


def _effects(rng, kind: str, size_dps: float, recordings: int) -> list[dict]:
    if kind in _JUMP_FLOORS:
        dps = [float(_JUMP_FLOORS[kind] * _FLOOR_DPS * s) for s in rng.choice([-1, 1], 3)]
        own = int(rng.integers(1, recordings + 1))
        return [{"kind": "step", "at_s": rng.uniform(700, 2600), "dps": dps, "session": own}]
    form: dict[str, dict] = {
        "hysteresis": {
            "kind": "prandtl-ishlinskii",
            "widths_degc": [float(w) for w in rng.uniform(2.0, 20.0, 3)],
            "kept_off_degc": [float(d) for d in rng.normal(0, 3.0, recordings + 1)],
        },
        "lag": {"kind": "sensor-lag", "tau_s": rng.uniform(40, 300)},
        "kink": {"kind": "kink", "knee_degc": rng.uniform(28, 36)},
    }
    if kind not in form:
        return []
    return [{**form[kind], "rms_dps": size_dps, "beyond_temperature": True}]
