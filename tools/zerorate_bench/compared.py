"""`compare` on every open recording, and on BROAD beside the truth that the optics tell."""

import tempfile
from collections.abc import Callable
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from zerorate_tools.compare import Compared, compare
from zerorate_tools.compare.judge import FIRST_REST, FRESH, NOTHING, TooFewRests, rests_of
from zerorate_tools.demo.broad import Trial, trials, true_bias
from zerorate_tools.importers import import_recording
from zerorate_tools.loop.read.still import ticks_with_spread
from zerorate_tools.peers import firmware, fusion, given, vqf_default

from .public_data import recordings, recordings_folder, told_of
from .tables import table

_WAYS = (NOTHING, FIRST_REST, "vqf", "imufusion", FRESH)
_LEAD_S = 3.0
_SIGMAS = 2.0
SAME = "no difference"


def run(data: Path | None, advance: Callable[[float], None]) -> dict[str, Any]:
    """recordings: name -> rests, heading (deg/min by way), verdict of zerorate against the first
    rest, or why there is none; broad: trial -> pairs of ways, judged by the log and the truth."""
    folder = recordings_folder(data)
    found: dict[str, Any] = {"recordings": {}, "broad": {}}
    by_name = {trial.name: trial for trial in trials(folder / "broad")}
    with tempfile.TemporaryDirectory(prefix="zerorate-bench-") as scratch:
        for source in [*recordings(folder), *sorted(folder.glob("chamber-loop/*.gz"))]:
            name = f"{source.parent.name}/{source.name.split('.')[0]}"
            log = Path(scratch) / f"{name.replace('/', ' ')}.parquet"
            import_recording(source, log, **told_of(source))
            try:
                compared = compare([log])
            except TooFewRests as error:
                found["recordings"][name] = {"rests": 0, "why": error.problem.split(",")[0]}
            else:
                found["recordings"][name] = _row(compared)
                if source.stem in by_name:
                    found["broad"][source.stem] = beside_truth(compared, by_name[source.stem], log)
            advance(1)
    return found


def _row(compared: Compared) -> dict[str, Any]:
    return {
        "rests": len(compared.rests),
        "heading_deg_per_min": {w: compared.heading_deg_per_min(w) for w in compared.error_dps},
        "verdict": short(compared.verdict(FRESH, FIRST_REST).word),
    }


def short(word: str) -> str:
    """A verdict's word, in a table."""
    return word if word in ("better", "worse") else SAME


def beside_truth(compared: Compared, trial: Trial, log: Path) -> list[dict[str, Any]]:
    """Of each pair of ways: one, other, by_log and by_truth (better, worse, SAME), and mdps of
    both by the optics."""
    error_mdps, sigma_mdps = errors_between(trial, log)
    rows = []
    for one, other in combinations(compared.error_dps, 2):
        apart = error_mdps[other] - error_mdps[one]
        sure = abs(apart) > _SIGMAS * sigma_mdps
        rows.append(
            {
                "one": one,
                "other": other,
                "by_log": short(compared.verdict(one, other).word),
                "by_truth": ("better" if apart > 0 else "worse") if sure else SAME,
                "mdps": [error_mdps[one], error_mdps[other]],
            }
        )
    return rows


def errors_between(trial: Trial, log: Path) -> tuple[dict[str, float], float]:
    """Way -> RMS error by the optics from the first question to the last, most of it in motion,
    mdps; and one sigma of the truth itself."""
    one, truth = given(trial.recording()), true_bias(trial)
    rests = rests_of(ticks_with_spread(log), one)
    biases = {
        NOTHING: np.zeros_like(one.rate_dps),
        FIRST_REST: np.broadcast_to(rests[0].bias_dps, one.rate_dps.shape),
        "vqf": vqf_default([one])[0],
        "imufusion": fusion([one])[0],
        FRESH: firmware()([one])[0],
    }
    part = slice(rests[1].first - round(_LEAD_S * trial.hz), rests[-1].first)
    rms = {
        way: 1e3 * float(np.sqrt(np.mean((bias[part] - truth.bias_dps) ** 2)))
        for way, bias in biases.items()
    }
    return rms, 1e3 * float(np.sqrt(np.mean(truth.sigma_dps**2)))


def in_markdown(found: dict[str, Any]) -> str:
    """Both tables, each with what it says above it."""
    rows = []
    for name, row in found["recordings"].items():
        heading = row.get("heading_deg_per_min", {})
        cells = [f"{heading[way]:.2f}" if way in heading else "" for way in _WAYS]
        rows.append([name, str(row["rests"]), *cells, row.get("verdict", row.get("why", ""))])
    words = [row.get("verdict") for row in found["recordings"].values()]
    text = (
        f"Of {len(words)} recordings zerorate is better than the mean of the first rest in "
        f"{words.count('better')}, worse in {words.count('worse')}; {words.count(SAME)} show no "
        f"difference, {words.count(None)} have no two rests. Heading lost, degrees a minute:"
    )
    heads = ["recording", "later rests", *_WAYS, "zerorate against the first rest"]
    return "\n\n".join([text, table(heads, rows), *_of_truth(found["broad"])])


def _of_truth(broad: dict[str, list[dict[str, Any]]]) -> list[str]:
    if not broad:
        return []
    pairs = [pair for rows in broad.values() for pair in rows]
    sure = [pair for pair in pairs if pair["by_log"] != SAME]
    beyond = sum(pair["by_log"] == pair["by_truth"] for pair in sure)
    text = (
        f"On BROAD the log alone is sure who is better in {len(sure)} of {len(pairs)} pairs of "
        f"ways: {sum(not denied(pair) for pair in sure)} as the truth says ({beyond} by more than "
        f"the truth's own uncertainty), {sum(denied(pair) for pair in sure)} against it. The truth "
        f"tells {sum(p['by_truth'] != SAME for p in pairs)} apart. Zerorate against the first rest:"
    )
    rows = []
    for name, of_trial in broad.items():
        pair = next(p for p in of_trial if (p["one"], p["other"]) == (FIRST_REST, FRESH))
        other = {"better": "worse", "worse": "better", SAME: SAME}
        rows.append(
            [name, *(f"{e:.1f}" for e in pair["mdps"])]
            + [other[pair["by_log"]], other[pair["by_truth"]]]
        )
    heads = ["trial", "first rest, true error mdps", "zerorate", "by the log", "by the truth"]
    return [text, table(heads, rows)]


def denied(pair: dict[str, Any]) -> bool:
    """Whether the log is sure of one way, and the optics find the other nearer, however little."""
    one, other = pair["mdps"]
    return pair["by_log"] == ("worse" if one < other else "better")


def passed(found: dict[str, Any]) -> bool:
    """Whether the log never says the reverse of the truth."""
    return not any(denied(pair) for rows in found["broad"].values() for pair in rows)
