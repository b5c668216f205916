"""Truth within two sigma on parts with more and less flicker noise: the firmware, Bayes' rule."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.peers import given
from zerorate_tools.peers.firmware import Decision
from zerorate_tools.recordings import Recording
from zerorate_tools.simulate import Truth, simulate
from zerorate_tools.simulate.description import load_description
from zerorate_tools.simulate.schema import Description

from .bayes import believed, segments

FLICKERS_MDPS = (0, 1, 2, 4)
SCENES = ("rests-30", "short-rests", "turntable")
SEEDS = range(1, 11)
_STRETCH_S = 10.0


def by_flicker() -> dict:
    """Scene -> "firmware", "Bayes' rule" -> mean share within two sigma, each flicker noise's."""
    found: dict = {}
    for name in SCENES:
        scenes = [with_flicker(name, mdps / 1000) for mdps in FLICKERS_MDPS]
        shares = np.mean([[_shares(scene, seed) for scene in scenes] for seed in SEEDS], axis=0)
        found[name] = dict(zip(("firmware", "Bayes' rule"), np.round(shares.T, 4).tolist()))
    return found


def with_flicker(name: str, flicker_dps: float) -> Description:
    """The bundled scene, its part with that flicker noise."""
    described = load_description(name)
    return replace(described, noise=replace(described.noise, bias_instability_dps=flicker_dps))


def _shares(scene: Description, seed: int) -> tuple[float, float]:
    recording, truth = simulate(scene, session=1, seed=seed)
    firmware = Decision()
    firmware.truth_dps = [truth.bias_lsb / recording.scales.gyro_lsb_per_dps]
    firmware([given(recording)])
    error, sigma = bayes_error(scene, recording, truth)
    return float(np.mean(firmware.within)), float(np.mean(np.abs(error) < 2 * sigma))


def bayes_error(
    scene: Description, recording: Recording, truth: Truth
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Error and one sigma by Bayes' rule, dps, at each end of ten seconds after the first rest."""
    hz = recording.scales.odr_hz
    warm = truth.temp_degc - truth.temp_degc[0]
    noise_dps = scene.sensor.gyro_noise_dps
    rests = segments(recording.gyro_dps(), warm, truth.still, hz, noise_dps)
    every = round(_STRETCH_S * hz)
    ends = np.arange(every, len(warm) + 1, every)
    ends = ends[ends >= rests.spans.end_s[0] * hz]
    bias, sigma = believed(rests, ends / hz, warm[ends - 1], 1 / hz)
    return bias - truth.bias_lsb[ends - 1] / recording.scales.gyro_lsb_per_dps, sigma
