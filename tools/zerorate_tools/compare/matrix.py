"""What the matrix of scale factors and axes would win, from the logs alone: their own motion."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..loop.motion.by_windows import GRAVITY, UNIT, by_windows, seen_in_words
from ..loop.motion.moving import moving_of
from ..loop.read.gate import CannotClose

HEAD = "in motion, deg/min, left out"
WITHOUT, WITH = "without the matrix", "with the matrix"


@dataclass(frozen=True)
class Won:
    """turned: degrees a minute of windows left out, without and with; unit: what turns them;
    heading: the same of heading against the given attitude, None without one; deployed: whether
    `close` would deploy it; refused: why the logs are not of one device, "" where they are.
    """

    turned: tuple[float, float] = (float("nan"), float("nan"))
    unit: str = UNIT[GRAVITY]
    heading: tuple[float, float] | None = None
    deployed: bool = False
    refused: str = ""

    def sentence(self) -> str:
        if self.refused:
            return f"In motion: {self.refused}."
        before, after = self.turned
        if not self.deployed:
            return f"In motion no matrix would lower the error: {seen_in_words(before, self.unit)}."
        more = ""
        if self.heading is not None:
            more = f", and {self.heading[1]:.2f} of {self.heading[0]:.2f} of heading"
        return (
            f"In motion the matrix of `zerorate close` would leave {after:.2f} of {before:.2f} "
            f"{self.unit}{more}, on windows left out."
        )

    def rows(self) -> list[tuple[str, str, str, str]]:
        """A head, and a row each, without and with: its name, what turns windows, heading, both in
        degrees a minute."""
        if self.refused:
            return []
        names = (WITHOUT, WITH) if self.deployed else (WITHOUT,)
        none = "no attitude" if self.unit == UNIT[GRAVITY] else ""
        headings = [f"{h:.2f}" for h in self.heading] if self.heading else [none] * 2
        head = (HEAD, self.unit.rpartition(" ")[2], "heading", "")
        return [head, *((n, f"{t:.2f}", h, "") for n, t, h in zip(names, self.turned, headings))]


def matrix_of(logs: Sequence[str | Path]) -> Won | None:
    """What the matrix of the logs' device would win; None where too little of them moves.

    Raises BadRecording.
    """
    try:
        shown = by_windows([m for log in logs if (m := moving_of(log)) is not None], [])
    except CannotClose as problem:
        return Won(refused=str(problem))
    if shown is None:
        return None
    heading = shown.heading if shown.found else None
    return Won((shown.before, shown.after), shown.unit, heading, shown.found)
