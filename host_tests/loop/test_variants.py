"""Real recordings as others might have made them: what `zerorate bench variants` counts."""

import numpy as np
from zerorate_bench.loop import variants
from zerorate_tools.recordings import Recording, Scales


def _recording(samples=1000):
    at = np.arange(samples, dtype=np.int64) * 10_000
    axes = ("gx", "gy", "gz", "ax", "ay", "az")
    columns = {"t_us": at, **{n: np.zeros(samples, np.int32) for n in axes}}
    return Recording(columns, Scales("MPU-6050", 100.0, 131.0, 16384.0))


def test_halves_are_all_of_a_recording_once():
    halves = variants.VARIANTS["two halves, as two recordings"](_recording())
    assert np.array_equal(
        np.concatenate([h.columns["t_us"] for h in halves]), _recording().columns["t_us"]
    )


def test_a_step_put_in_has_its_size_on_every_axis():
    stepped = variants._with_step(_recording(100_000), 0.05)
    change = [np.diff([np.split(stepped.columns[g], [60_000])[i].mean() for i in (0, 1)])[0]
              for g in ("gx", "gy", "gz")]  # fmt: skip
    assert np.allclose(np.array(change) / 131.0, 0.05 * np.array([1.0, -0.7, 0.5]), atol=1e-4)


def test_a_step_counts_as_listed_near_its_place_alone():
    recording = _recording()
    assert variants._is_listed([{"t_us": 6_050_000}], recording)
    assert not variants._is_listed([{"t_us": 8_000_000}], recording)


def test_the_page_counts_what_is_worse_and_names_it_on_the_other_half():
    row = {"recording": "a.csv", "variant": variants.FIRST, "found": "thermal-lag"}
    rows = [
        {**row, "before_mdps": 10.0, "after_mdps": 10.5}
        | {"other_before_mdps": 10.0, "other_after_mdps": 12.0},
        {**row, "recording": "b.csv", "refused": "too short"},
    ]
    said = variants.in_words(rows)
    assert "| its first half | 1 | 1 | 1 | 1 | 1.05 |" in said
    assert "By its first half alone, worse on the second of 1: a.csv." in said
