"""How fast the source against gravity settles, and how far it ripples then."""

import numpy as np

from ..peers import given
from ..peers.sources import Source
from ..simulate import simulate

NEAR_MDPS = 50.0
_RIPPLE_S = 200.0
_OBSERVABLE = (0, 1)
_RESTING = {
    "name": "flat on a table",
    "seed": 1,
    "sensor": {"odr_hz": 100.0, "gyro_noise_dps": 0.05},
    "bias": {"b0": [2.0, -1.5, 0.7]},
    "session": [
        {
            "start_degc": 25.0,
            "temperature": [{"to": 25.0, "minutes": 15}],
            "motion": [{"kind": "rest", "minutes": 15}],
        }
    ],
}
FORMS = {
    "coarse, then fine (the default)": {},
    "the document's own form, steps of 50 mdps": {
        "document": True,
        "coarse_dps": 0.05,
        "threshold": 0,
    },
    "the document's own form, steps of 12.5 mdps": {
        "document": True,
        "coarse_dps": 0.0125,
        "threshold": 0,
    },
}


def settling() -> dict:
    """Form -> seconds until within 50 mdps, and the ripple (standard deviation) at the end, mdps.

    On a device that lies flat with biases of 2.0 and -1.5 dps on its level axes; the slower, and
    the worse, of the two. The third axis points along gravity and is not observable.
    """
    recording, truth = simulate(_RESTING)
    one = given(recording)
    bias = truth.bias_lsb / recording.scales.gyro_lsb_per_dps
    found = {}
    for form, options in FORMS.items():
        error = 1000 * (Source("gravity", **options)([one])[0] - bias)[:, _OBSERVABLE]
        near = np.abs(error) < NEAR_MDPS
        first = np.where(near.any(axis=0), near.argmax(axis=0) / one.odr_hz, np.inf)
        last = error[-round(_RIPPLE_S * one.odr_hz) :]
        found[form] = {
            "seconds": round(float(first.max()), 1),
            "ripple_mdps": round(float(last.std(axis=0).max()), 1),
            "mean_mdps": round(float(np.abs(last.mean(axis=0)).max()), 1),
        }
    return found
