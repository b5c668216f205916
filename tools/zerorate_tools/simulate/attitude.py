"""Attitude as unit quaternions (w x y z), body to world, world z up."""

import numpy as np

_STRIDE = 16
IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


def multiply(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """(..., 4) Hamilton product."""
    pw, px, py, pz = (p[..., i] for i in range(4))
    qw, qx, qy, qz = (q[..., i] for i in range(4))
    out = np.empty(np.broadcast_shapes(p.shape, q.shape))
    out[..., 0] = pw * qw - px * qx - py * qy - pz * qz
    out[..., 1] = pw * qx + px * qw + py * qz - pz * qy
    out[..., 2] = pw * qy - px * qz + py * qw + pz * qx
    out[..., 3] = pw * qz + px * qy - py * qx + pz * qw
    return out


def rotation(vector_deg: np.ndarray) -> np.ndarray:
    """(..., 4) rotation about each (..., 3) vector by its length in degrees."""
    half = np.radians(vector_deg) / 2
    angle = np.linalg.norm(half, axis=-1, keepdims=True)
    return np.concatenate([np.cos(angle), half * np.sinc(angle / np.pi)], axis=-1)


def integrate(rate_dps: np.ndarray, dt_s: float, start: np.ndarray) -> np.ndarray:
    """(n, 4) attitude after each sample; its rate (n, 3) is the mean over the dt before it."""
    return multiply(start, _running_product(rotation(rate_dps * dt_s)))


def _running_product(q: np.ndarray) -> np.ndarray:
    # blocks side by side, then their ends by the same rule: NumPy speed for a sequential product
    n = len(q)
    if n <= 1:
        return q
    blocks = -(-n // _STRIDE)
    padded = np.tile(IDENTITY, (blocks * _STRIDE, 1))
    padded[:n] = q
    padded = padded.reshape(blocks, _STRIDE, 4)
    for at in range(1, _STRIDE):
        padded[:, at] = multiply(padded[:, at - 1], padded[:, at])
    ends = _running_product(padded[:, -1].copy())
    padded[1:] = multiply(ends[:-1, None], padded[1:])
    out = padded.reshape(-1, 4)[:n]
    return out / np.linalg.norm(out, axis=-1, keepdims=True)


def into_body(attitude: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """(n, 3) world vector(s) (3,) or (n, 3) as seen from the body."""
    w, r = attitude[..., :1], attitude[..., 1:]
    vector = np.broadcast_to(vector, r.shape)
    t = -2 * np.cross(r, vector)
    return vector + w * t - np.cross(r, t)


def facing(up: np.ndarray) -> np.ndarray:
    """(4,) an attitude in which the body direction `up` points up."""
    up = np.asarray(up, float) / np.linalg.norm(up)
    if up[2] < -1 + 1e-12:
        return np.array([0.0, 1.0, 0.0, 0.0])
    q = np.r_[1 + up[2], np.cross(up, [0.0, 0.0, 1.0])]
    return q / np.linalg.norm(q)
