"""Words of the source in motion as numbers, vectors, turns and matrices, for its tests."""

from array import array

import numpy as np
from scipy.spatial.transform import Rotation
from zerorate.motion.motion_settings import motion_settings
from zerorate_tools.layout import COMPONENT

from .motions import stored, value_at

SETTINGS = motion_settings()
Q14, Q12 = 1 << 14, 4096
SIZE = COMPONENT.size
UPPER = np.triu_indices(3)  # 00 01 02 11 12 22, as the kernels keep a symmetric matrix


def numbers(state, at, count):
    return np.array([value_at(state, at + 2 * i) for i in range(count)])


def put_all(state, at, values):
    for i, value in enumerate(values):
        stored(state, at + 2 * i, value)


def put_words(state, at, values):
    state[at : at + len(values)] = array("i", [int(round(v)) for v in values])


def rotation_at(state, at):
    w, *xyz = state[at : at + 4]
    return Rotation.from_quat([*xyz, w])


def put_rotation(state, at, turn, scale):
    *xyz, w = turn.as_quat()
    put_words(state, at, scale * np.array([w, *xyz]))


def symmetric(six):
    matrix = np.zeros((3, 3))
    matrix[UPPER] = six
    return matrix + matrix.T - np.diag(matrix.diagonal())


def positive(draw, size=1.0):
    """A random positive definite matrix."""
    root = draw.normal(size=(3, 3))
    return size * (root @ root.T + 0.1 * np.eye(3))
