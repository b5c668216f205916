"""What a report says in sentences; every number in them is one of report.json."""

from typing import Any

from ..loop.read.turns import GIVEN
from ..numbers import figure
from .kinds import title

Report = dict[str, Any]


def headline(result: Report) -> str:
    """The answer, plain text: what the learning firmware leaves, then the frozen comparison."""
    return ". ".join(filter(None, (on_the_board(result), frozen(result))))


def on_the_board(result: Report) -> str:
    """What is left where the firmware goes on learning; nothing where it was not run."""
    if "online" not in result:
        return ""
    whole = result["online"]["in_all"]
    said = f"On the board, which goes on learning, {figure(whole['after_mdps'])} mdps are left"
    if any(corrects_at_rest(effect) for effect in result["effects"]):
        said += f", {figure(whole['before_mdps'])} without the effects"
    return said


def why_both(result: Report) -> str:
    """Why a report has both figures; nothing where the firmware was not run."""
    if "online" not in result:
        return ""
    if "how_much_weaker" in result["split"]:
        return (
            "The board begins the recording knowing nothing and learns as it goes, so its first "
            "minutes are in its figure. Frozen knows what the pieces around each one taught: it is "
            "what a board has that went through such a course before."
        )
    left, frozen_left = (r["in_all"]["after_mdps"] for r in (result["online"], result))
    little = ", so little is left there with or without a model" if left < frozen_left else ""
    return (
        f"The board learns the bias anew at every rest{little}. Frozen is as if the device never "
        "rested again after its first minute: it shows what the model knows by itself, which "
        "counts for as long as the device moves."
    )


def frozen(result: Report) -> str:
    """What the comparison of frozen models says."""
    whole = result["in_all"]
    before, after, floor = (figure(whole[k]) for k in ("before_mdps", "after_mdps", "floor_mdps"))
    where = _where(result)
    if result["verdict"] == "unexplained-residual":
        return f"{where}, {after} mdps are left that nothing recorded explains (floor {floor})"
    if not any(corrects_at_rest(effect) for effect in result["effects"]):
        return (
            f"Nothing was found {_what(result)} that the firmware does not already correct: "
            f"{where[0].lower()}{where[1:]}, the error is {before} mdps (floor {floor})"
        )
    if whole["after_mdps"] < whole["before_mdps"]:
        return f"{where}, the error fell from {before} to {after} mdps (floor {floor})"
    return (
        f"{where}, what was found did not help: the error went from {before} to {after} mdps "
        f"(floor {floor})"
    )


def corrects_at_rest(effect: Report) -> bool:
    """Whether it changes what is left at rest: not what shows in motion, or is said only."""
    return bool(effect["coefficients"]) and "in_motion" not in effect


def _what(result: Report) -> str:
    """What was looked at: rests, or motion too, where the true rate is known."""
    beside = result.get("truth", {}).get("in_motion") == GIVEN
    return "in the bias, beside the reference," if beside else "at rest"


def _where(result: Report) -> str:
    alone = "how_much_weaker" in result["split"]
    where = "the stretches" if alone else "the session"
    return f"Frozen, on {where} held out" if "online" in result else f"On {where} held out"


def how_sure(effect: Report) -> str:
    """What confirmed or tentative means here."""
    if effect["confidence"] == "confirmed" and not corrects_at_rest(effect):
        return "Confirmed: what was held out and took no part in finding it shows it too."
    if effect["confidence"] == "confirmed":
        return (
            "Confirmed: it also lowers the error on the recording that was held out and took no "
            "part in finding it, and nothing beyond the part's own noise is left there."
        )
    return (
        "Tentative: it was found in the recordings that were fitted on, but what was held out "
        "does not settle it. Record more before you rely on it."
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
