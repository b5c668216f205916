"""The matrix of a model's rate slots, as other programs take it."""

from dataclasses import replace

import numpy as np

from .model import Model
from .term import Term

_RATES = ("rate_x", "rate_y", "rate_z")
#: Flight controllers that have no such parameter, and what they do with a gyroscope's readings.
_WITHOUT = (
    "Betaflight, iNav: no setting takes it. They subtract gyroZero (iNav: gyro_zero_x, _y, _z) "
    "and rotate by align_* and no more.",
    "ArduPilot: no parameter takes it. It subtracts INS_GYROFFS_X, _Y, _Z and rotates by "
    "AHRS_ORIENTATION and no more.",
)


def rate_matrix(model: Model) -> np.ndarray | None:
    """(3, 3) C of `corrected = C measured`, what the rate slots do; None without such slots."""
    found = np.zeros((3, 3))
    for slot in model.slots:
        if slot.term.source in _RATES and _is_plain(slot.term):
            found[:, _RATES.index(slot.term.source)] += slot.coefficient_dps
    return np.eye(3) - found if found.any() else None


def _is_plain(term: Term) -> bool:
    return term == replace(Term(term.source, term.lo, term.hi), centre=term.centre)


def matrix_in_words(model: Model) -> list[str]:
    """Lines to copy: the matrix itself, and what takes it in other programs; none without one."""
    matrix = rate_matrix(model)
    if matrix is None:
        return []
    sensitivity = np.diag(matrix)
    # FusionModelInertial: misalignment (sensitivity * (measured - offset))
    misalignment = matrix / sensitivity
    # kalibr's scale-misalignment model: measured = M C_gyro_i true + bias, M lower triangular
    lower, rotation = _lower_and_rotation(np.linalg.inv(matrix))
    return [
        "corrected rate = matrix x (measured rate - bias), no unit:",
        *_rows(matrix),
        "x-io Fusion: FusionModelInertial, offset is the bias:",
        "  misalignment:",
        *_rows(misalignment, "    "),
        f"  sensitivity: {_numbers(sensitivity)}",
        "kalibr, imu.yaml, model scale-misalignment:",
        *_yaml("gyroscopes", {"M": lower, "C_gyro_i": rotation}),
        # OpenVINS inverts Tw and transposes R_IMUtoGYRO; its model "kalibr" has Tw lower triangular
        "OpenVINS (ROS 1 and 2), kalibr_imu_chain.yaml, model kalibr:",
        *_yaml("imu0", {"Tw": lower, "R_IMUtoGYRO": rotation}),
        *_WITHOUT,
    ]


def _lower_and_rotation(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower triangular with a positive diagonal, and a rotation, whose product is the matrix."""
    from scipy.linalg import rq  # which recording and flashing do without

    upper, turn = rq(matrix[::-1, ::-1])
    lower, rotation = upper[::-1, ::-1], turn[::-1, ::-1]
    signs = np.sign(np.diag(lower))
    return lower * signs, rotation * signs[:, None]


def _yaml(heading: str, matrices: dict[str, np.ndarray]) -> list[str]:
    parts = [[f"    {name}:", *_rows(m, "    - ", yaml=True)] for name, m in matrices.items()]
    return [f"  {heading}:", *(line for part in parts for line in part)]


def _rows(matrix: np.ndarray, before: str = "  ", yaml: bool = False) -> list[str]:
    return [before + (f"[{_numbers(r, ', ')}]" if yaml else _numbers(r)) for r in matrix]


def _numbers(values: np.ndarray, between: str = "  ") -> str:
    return between.join(f"{v + 0.0:.6f}" for v in values)
