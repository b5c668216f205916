"""Words of the source in motion as numbers, vectors, turns and matrices, for its tests."""

from array import array

import numpy as np
from scipy.spatial.transform import Rotation
from zerorate.arithmetic.real import pack, unpack
from zerorate.motion.motion_settings import motion_settings
from zerorate_tools.layout import MOTION, ROW

from .motions import stored, value_at

SETTINGS = motion_settings()
Q14, Q12, Q11 = 1 << 14, 4096, 2048
SIZE = ROW.size


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


def packed_at(state, at, count):
    """Numbers of one word each."""
    found = []
    for i in range(count):
        unpack(state, MOTION.T, at + i)
        found.append(value_at(state, MOTION.T))
    return np.array(found)


def put_packed(state, at, values):
    for i, value in enumerate(values):
        stored(state, MOTION.T, value)
        pack(state, at + i, MOTION.T)


def covariance_at(state, count=12):
    """The covariance that the filter holds, over the push's variance."""
    held, matrix = packed_at(state, MOTION.KNOWN, 78), np.zeros((12, 12))
    matrix[np.tril_indices(12)] = held
    matrix = matrix + np.tril(matrix, -1).T
    return matrix[:count, :count]


def put_covariance(state, matrix):
    put_packed(state, MOTION.KNOWN, matrix[np.tril_indices(12)])


def positive(draw, size=1.0, count=3):
    """A random positive definite matrix."""
    root = draw.normal(size=(count, count))
    return size * (root @ root.T + 0.1 * np.eye(count))
