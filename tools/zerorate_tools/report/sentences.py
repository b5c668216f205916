"""What a report says in sentences; every number in them is one of report.json."""

from collections.abc import Mapping
from typing import Any

from ..loop.motion.by_windows import GIVEN
from ..numbers import figure
from .kinds import title

Report = Mapping[str, Any]


#: Less than this share of the error before is left: most of it is explained, or a board gains.
_MOST, _WORTH = 0.5, 0.8


def headline(result: Report) -> str:
    """The answer, plain text: effect, gain on held-out data, gain of a board that learns."""
    return ". ".join(filter(None, (on_held_out(result), on_the_board(result))))


def on_held_out(result: Report) -> str:
    """What was found, and the error without and with it on data that it was not fitted to."""
    whole = result["in_all"]
    before, after, floor = (figure(whole[k]) for k in ("before_mdps", "after_mdps", "floor_mdps"))
    unexplained = result["verdict"] == "unexplained-residual"
    names = [title(e["effect"], e["sources"]) for e in result["effects"] if corrects_at_rest(e)]
    left = f"{after} mdps on held-out data (noise floor {floor})"
    if not names:
        nothing = "that the firmware does not already correct"
        why = "that explains the error" if unexplained else nothing
        return f"Nothing was found {_what(result)} {why}: {left}"
    named = capital(", ".join(names[:-1]) + " and " * (len(names) > 1) + names[-1])
    if whole["after_mdps"] >= whole["before_mdps"]:
        return f"{named}: no gain, {before} to {left}"
    share = "most" if whole["after_mdps"] < _MOST * whole["before_mdps"] else "part"
    verb = "explains" if len(names) == 1 else "explain"
    rest = ". No recorded channel explains the rest" if unexplained else ""
    return f"{named} {verb} {share} of the error: {before} to {left}{rest}"


def on_the_board(result: Report) -> str:
    """What is left where the firmware goes on learning; nothing where it was not run."""
    if "online" not in result:
        return ""
    before, after = (result["online"]["in_all"][k] for k in ("before_mdps", "after_mdps"))
    who = "A board that keeps learning at rest"
    if not any(map(corrects_at_rest, result["effects"])):
        return f"{who} leaves {figure(after)} mdps"
    gain = "nothing" if after >= before else "little" if after > _WORTH * before else "too"
    return f"{who} gains {gain}: {figure(before)} to {figure(after)} mdps"


def why_both(result: Report) -> str:
    """Why a report has both figures; nothing where the firmware was not run."""
    if "online" not in result:
        return ""
    if "how_much_weaker" in result["split"]:
        return (
            "The board starts the recording with nothing learned, so its figure includes its first "
            "minutes. The model of the held-out figure was fitted to the other pieces."
        )
    left, held_out = (r["in_all"]["after_mdps"] for r in (result["online"], result))
    little = ", so little is left with or without a model" if left < held_out else ""
    return (
        f"The board measures the bias at every rest{little}. On held-out data the model works "
        "alone: the device never rests after its first minute. This gain counts while the device "
        "moves."
    )


def corrects_at_rest(effect: Report) -> bool:
    """Whether it changes what is left at rest: not what shows in motion, or is said only."""
    return bool(effect["coefficients"]) and "in_motion" not in effect


def _what(result: Report) -> str:
    """What was looked at: rests, or motion too, where the true rate is known."""
    beside = result.get("truth", {}).get("in_motion") == GIVEN
    return "in the bias, beside the reference," if beside else "at rest"


def how_sure(effect: Report) -> str:
    """What confirmed or tentative means here."""
    if effect["confidence"] != "confirmed":
        return (
            "Tentative: the fitted recordings show it, but the held-out data do not settle it. "
            "Record more before you rely on it."
        )
    if not corrects_at_rest(effect):
        return "Confirmed: the held-out data, which took no part in finding it, show it too."
    return (
        "Confirmed: it also lowers the error of the held-out recording, which took no part in "
        "finding it, and leaves nothing but the part's own noise there."
    )


def found_in_short(result: Report) -> str:
    """One sentence on what was found."""
    names = [f"{title(s['effect'], s['sources'])} ({s['confidence']})" for s in result["effects"]]
    if not names:
        return "No effect was found beyond the line over temperature that the firmware learns."
    return f"{len(names)} effect{'s' if len(names) > 1 else ''} found: {'; '.join(names)}."


def capital(text: str) -> str:
    """With a capital at its beginning."""
    return text[:1].upper() + text[1:]


def sentence(text: str) -> str:
    """With a capital at its beginning and a full stop at its end."""
    return capital(text) + ("" if text.endswith((".", "!", "?")) else ".")
