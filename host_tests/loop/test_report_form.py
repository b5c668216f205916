"""report.json has the form of design.md, whatever was found."""

import json
import math

import pytest

THREE = (float, float, float)
INTERVALS = [(float, float)]
BOTH = {"before": INTERVALS, "after": INTERVALS}
#: A type, [of each of any number], (of each of so many) or {key: of its value}.
EFFECT = {
    **{"effect": str, "sources": [str], "parameters": [dict], "coefficients": dict},
    **{"confidence": str, "before_mdps": THREE, "after_mdps": THREE, "ci95_mdps": INTERVALS},
    **{"p_value": float, "confounded_with": [str], "said": str},
}
FORM = {
    "split": {"unit": str, "train": [str], "test": [str], "block_s": float},
    **{"floor_mdps": THREE, "before_mdps": THREE, "after_mdps": THREE, "ci95_mdps": BOTH},
    "in_all": {"before_mdps": float, "after_mdps": float, "floor_mdps": float, "ci95_mdps": dict},
    "online": {"before_mdps": THREE, "after_mdps": THREE, "ci95_mdps": BOTH},
    "turn_on_offset_dps": {"before": [THREE], "after": [THREE]},
    **{"integer_rounding_mdps": THREE, "integer_rounding_of_floor": float, "measured_by": str},
    "effects": [EFFECT],
    "events": [{"kind": str, "t_us": int, "recording": str, "size_mdps": THREE}],
    "unexplained": {"rms_mdps": THREE, "what_is_known": str, "measure_next": [str]},
    **{"smallest_detectable_mdps": dict, "verdict": str, "truth": dict, "gate": dict},
}


def breaches(value, form, where="report"):
    """Where a value has not the form, in words."""
    if isinstance(form, dict):
        if not isinstance(value, dict):
            return [f"{where} is no object"]
        absent = [f"{where} lacks {key}" for key in form if key not in value]
        inside = [breaches(value[k], f, f"{where}.{k}") for k, f in form.items() if k in value]
        return [*absent, *(b for part in inside for b in part)]
    if isinstance(form, (list, tuple)):
        if not isinstance(value, list) or (isinstance(form, tuple) and len(value) != len(form)):
            return [f"{where} is no list of {len(form)}"]
        forms = form if isinstance(form, tuple) else form * len(value)
        return [
            b for i, (v, f) in enumerate(zip(value, forms)) for b in breaches(v, f, f"{where}[{i}]")
        ]
    if form is float:
        fine = isinstance(value, (int, float)) and not isinstance(value, bool)
        return [] if fine and math.isfinite(value) else [f"{where} is {value!r}, no number"]
    return [] if isinstance(value, form) else [f"{where} is {value!r}, no {form.__name__}"]


@pytest.fixture(scope="module")
def written(closed):
    return json.loads((closed[1] / "report.json").read_text())


def test_every_entry_is_there_and_of_its_kind(written):
    assert breaches(written, FORM) == []


def test_words_are_those_of_the_design(written):
    assert written["verdict"] in ("nothing-found", "effects-found", "unexplained-residual")
    assert {s["confidence"] for s in written["effects"]} <= {"confirmed", "tentative"}


def test_effects_keep_their_old_name_for_a_version(written):
    assert written["steps"] == written["effects"]


def test_coefficients_are_three_for_every_source_of_an_effect(written):
    for effect in written["effects"]:
        assert set(effect["coefficients"]) <= set(effect["sources"])
        assert breaches(list(effect["coefficients"].values()), [THREE]) == []


def test_nothing_is_left_half_written(closed):
    names = {path.name for path in closed[1].iterdir()}
    wanted = {"report.html", "report.json", "model.json", "model.bin", "corrected.parquet"}
    assert names == wanted


def test_a_wrong_form_is_noticed(written):
    broken = {**written, "floor_mdps": [1.0, None, 2.0], "effects": [{}]}
    assert "report.floor_mdps[1] is None, no number" in breaches(broken, FORM)
    assert "report.effects[0] lacks effect" in breaches(broken, FORM)
