"""Raw counts: words of 16 bits, however a program printed their sign."""

from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ...recordings.recording import ACCEL, GYRO, TEMP

_BEYOND, _SPAN = 1 << 15, 1 << 16
#: Words with a sign turn from 32,767 to 32,768 at the end of the range, where readings are rare.
_MIDDLE, _MOST_IN_MIDDLE = (24_576, 40_960), 0.01
_KINDS = {"gyro": GYRO, "accel": ACCEL, "temp": (TEMP,)}


class Counts:
    """Gives counts that were printed without a sign theirs, and says what cannot be counts."""

    def __init__(self, raw: frozenset[str]) -> None:
        self._seen = {kind: _Seen() for kind in sorted(raw)}

    def signed(self, columns: dict[str, np.ndarray]) -> None:
        """Turn 32,768 to 65,535 into negative counts, in place."""
        for kind, seen in self._seen.items():
            for name in _KINDS[kind]:
                if name in columns:
                    values = columns[name]
                    seen.add(values[np.isfinite(values)])
                    turned = (values >= _BEYOND) & (values < _SPAN)
                    columns[name] = np.where(turned, values - _SPAN, values)

    def notes(self, path: Path) -> list[str]:
        """What was taken for what. Raises BadRecording where the counts are of another kind."""
        for kind, seen in self._seen.items():
            seen.refuse(kind, path)
        turned = [kind for kind, seen in self._seen.items() if seen.most >= _BEYOND]
        return [f"{kind}: counts of 32768 and more are negative ones" for kind in turned]


class _Seen:
    def __init__(self) -> None:
        self.least, self.most, self.middle, self.size = float("inf"), 0.0, 0, 0

    def add(self, values: np.ndarray) -> None:
        self.least = min(self.least, float(values.min(initial=np.inf)))
        self.most = max(self.most, float(values.max(initial=0.0)))
        self.middle += int(((values >= _MIDDLE[0]) & (values < _MIDDLE[1])).sum())
        self.size += len(values)

    def refuse(self, kind: str, path: Path) -> None:
        span = f"{kind}: counts from {self.least:.0f} to {self.most:.0f}"
        unsigned = 0 <= self.least and _BEYOND <= self.most < _SPAN
        if unsigned and self.middle > _MOST_IN_MIDDLE * self.size:
            problem = f"{span} are around 32768, where a word of 16 bits changes its sign"
            raise BadRecording(path, problem, do="subtract 32768 from each and import that")
        if not unsigned and not (-_BEYOND <= self.least and self.most < _BEYOND):
            do = "divide them by their scale, and import deg/s, g or degC"
            raise BadRecording(path, f"{span} are no words of 16 bits", do=do)
