"""`bench deceived`: its worlds are what they say, and who is sure of a wrong bias is counted."""

import numpy as np
import pytest
from zerorate_bench import deceived
from zerorate_bench.deceived import COLD, KNOWN, in_markdown, judged, made
from zerorate_bench.deceived_worlds import WORLDS

OF_GRAVITY = ("aircraft in coordinated turns", "boat, 0.05 to 0.5 degrees", "coning, 1 to 5 dps")


@pytest.mark.parametrize("name", WORLDS)
def test_a_world_is_the_same_for_a_seed_and_another_for_the_next(name):
    one, again, other = made(name, 3, True), made(name, 3, True), made(name, 4, True)
    assert np.array_equal(one.recording.columns["gz"], again.recording.columns["gz"])
    assert not np.array_equal(
        one.recording.columns["gz"][:2000], other.recording.columns["gz"][:2000]
    )


@pytest.mark.parametrize("name", ["robot vacuum", "car, long gentle curves, stops"])
def test_gravity_does_not_show_a_turn_about_the_vertical(name):
    run = made(name, 1, False)
    assert run.recording.accel_g().std(axis=0).max() < 0.006
    assert np.abs(run.recording.gyro_dps() - run.bias_dps).max() > 1.0


@pytest.mark.parametrize("name", OF_GRAVITY)
def test_gravity_in_the_body_moves_where_the_world_says_so(name):
    accel_g = made(name, 1, False).recording.accel_g()
    assert np.ptp(accel_g, axis=0).max() > 0.03


def test_a_resting_device_is_never_sure_of_a_wrong_bias(monkeypatch):
    monkeypatch.setitem(WORLDS, "rest", lambda start: deceived.Bout(np.zeros((len(start.t_s), 3))))
    found = judged(made("rest", 1, True))
    assert found["sure_s"] == 0 and found["worst_mdps"] == 0 and found["honest"] > 0.8


class Sure:
    """As `Decision`: half a dps off on one axis for a time, one sigma as given."""

    off_s, sigma_dps, run = 70.0, 0.01, None

    def states(self, one):
        bias, n = self.run.bias_dps.copy(), round(self.off_s * one.odr_hz)
        bias[-n:, 1] += 0.5
        return [bias, np.full(bias.shape, self.sigma_dps), np.ones(bias.shape, int)]


@pytest.mark.parametrize(
    ("off_s", "sigma_dps", "counts"), [(70, 0.01, 1), (50, 0.01, 0), (70, 0.2, 0)]
)
def test_only_who_is_sure_of_a_wrong_bias_for_a_minute_counts(
    monkeypatch, off_s, sigma_dps, counts
):
    run = made("robot vacuum", 0, False)
    peer = Sure()
    peer.off_s, peer.sigma_dps, peer.run = off_s, sigma_dps, run
    monkeypatch.setattr(deceived, "Decision", lambda: peer)
    found = judged(run)
    assert (found["sure_s"] > deceived.SURE_S) == counts
    assert found["worst_mdps"] == pytest.approx(500 if sigma_dps < 0.1 else 0)


@pytest.mark.parametrize(("sure_s", "said"), [(10.0, "yes"), (61.0, "**NO**")])
def test_the_page_says_of_each_row_whether_it_is(sure_s, said):
    rows = {"a world": [{"sure_s": sure_s, "worst_mdps": 50.0, "honest": 0.95}]}
    page = in_markdown({"seeds": 1, KNOWN: rows, COLD: rows, "followed": [True]})
    verdicts = [line.split("|")[-2].strip() for line in page.splitlines() if "| a world" in line]
    assert verdicts == [said, said]
