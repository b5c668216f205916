"""`zerorate bench`: cost and accuracy in one report."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from . import accuracy_report, cost_report
from .cost_report import STEPS, cost
from .limits import ACCURACY, COST, limits_table, verdicts
from .tables import machine_line


def steps(seeds: Sequence[int]) -> int:
    """How often `measure` advances."""
    return STEPS + accuracy_report.steps(seeds)


def measure(
    hours: Sequence[float], seeds: Sequence[int], advance: Callable[[float], None] = lambda n: None
) -> dict[str, Any]:
    """The figures of `cost` and of `accuracy` in one dict; `limits` holds those of both."""
    found = cost(advance, hours) | accuracy_report.accuracy(advance, seeds)
    found["limits"] = [verdict.to_json() for verdict in verdicts(found, COST + ACCURACY)]
    return found


def in_markdown(found: Mapping[str, Any]) -> str:
    """All limits first, then the tables of cost and of accuracy."""
    parts = ["# Figures\n", machine_line(found["machine"])]
    parts.append(limits_table(verdicts(found, COST + ACCURACY)))
    parts += cost_report.sections(found)
    parts += accuracy_report.sections(found)
    return "\n".join(parts)
