"""What motion shows, part by part: whether recordings are of one device, and how one moves."""

import numpy as np
import pytest
from scipy.stats import f as fisher
from zerorate_tools.loop.motion.device import LEVEL, DifferentDevices, Shown, check_one_device
from zerorate_tools.loop.motion.moving import Moving, _attitude_by


def said(entry, precision=1e8):
    """A recording that says of all nine entries that they are this."""
    return Shown(np.eye(9) * precision, np.full(9, precision * entry))


def parted(*entries, unsure=()):
    """(groups, unsure) that recordings a, b, c, ... are refused as, or None."""
    every = [*map(said, entries), *(said(entry, 1.0) for entry in unsure)]
    try:
        check_one_device([*zip("abcdefgh", every)])
    except DifferentDevices as error:
        return sorted(map(sorted, error.groups)), error.unsure
    return None


def test_recordings_of_two_devices_are_parted_and_those_that_tell_little_said_to_be_unsure():
    assert parted(0.005, 0.0051, -0.005) == ([["a", "b"], ["c"]], [])
    assert parted(-0.005, 0.005, 0.0051, -0.0051) == ([["a", "d"], ["b", "c"]], [])
    (one, other), unsure = parted(0.005, 0.0051, -0.005, -0.0051, unsure=[0.0])
    assert {*one, *other} == {*"abcde"} and {"a", "b"} <= {*one} | {*other} and unsure == ["e"]
    assert parted(0.005, 0.0051, 0.0049) is None and parted(0.005, -0.005) is None


@pytest.mark.parametrize(("share", "refused"), [(0.99, False), (1.01, True)])
def test_recordings_are_of_two_devices_beyond_one_chance_in_a_million_of_all_splits(share, refused):
    ratio = fisher.isf(LEVEL / 4, 9, 9)  # of the four ways to part three in two or none
    apart = share * np.sqrt(1.5 * ratio / 1e8)
    assert bool(parted(0.0, 0.0, apart)) is refused


@pytest.mark.parametrize(
    ("beside", "tilted", "is_planar"),
    [
        (0.0, 0.0, True),
        (0.09, 0.0, True),
        (0.11, 0.0, False),
        (0.0, 0.09, True),
        (0.0, 0.11, False),
    ],
)
def test_who_turns_about_one_axis_in_one_pose_moves_in_a_plane(beside, tilted, is_planar):
    at_s, accel = np.arange(3000) / 50, np.zeros((3000, 3))
    swing, slow = (np.sqrt(2) * np.sin(2 * np.pi * hz * at_s) for hz in (1.3, 0.05))
    rate = np.column_stack([beside * np.cos(2 * np.pi * 1.3 * at_s) * np.sqrt(2), 0 * swing, swing])
    size = np.sqrt(1 - beside**2)
    accel[:, 0], accel[:, 2] = tilted * slow, np.sqrt(1 - (tilted * slow) ** 2)
    every = np.ones(3000, bool)
    rate[:, 2] *= size
    one = Moving("x", rate, accel, at_s, every, ~every, np.zeros(3), np.zeros((0, 4)))
    assert one.planar is is_planar


def test_an_attitude_by_true_rates_is_known_where_these_are():
    rate = np.full((100, 3), [0.0, 0.0, 90.0])
    rate[40:45] = np.nan
    attitude = _attitude_by(rate, 0.02)
    assert np.isnan(attitude).all(axis=1).nonzero()[0].tolist() == [40, 41, 42, 43, 44]
    turned = 2 * np.degrees(np.arctan2(attitude[:, 3], attitude[:, 0]))
    steps = np.diff(turned)
    assert steps[np.isfinite(steps)] == pytest.approx(np.full(93, 1.8), abs=1e-6)
    assert turned[45] - turned[39] == pytest.approx(1.8, abs=1.9)
