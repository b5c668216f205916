"""Numbers, and lists of names, as a reader wants them."""

from collections.abc import Sequence

_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_LEAST, _MOST = -4, 6


def figure(value: float) -> str:
    """Three significant digits: 26.3, 0.808, 1,240, 5.9 × 10⁻⁵."""
    if value == 0:
        return "0"
    size = int(f"{value:.2e}".partition("e")[2])
    if _LEAST <= size < _MOST:
        return _minus(f"{value:,.{max(0, 2 - size)}f}")
    mantissa, _, exponent = f"{value:.1e}".partition("e")  # 9.96e-5 has another one than above
    power = str(int(exponent)).translate(_SUPERSCRIPTS)
    return _minus(f"{float(mantissa):g}") + f" × 10{power}"


def chance(p: float) -> str:
    """A p-value; what is below a millionth is not told apart."""
    return "below 10⁻⁶" if p < 1e-6 else figure(p)


def _minus(text: str) -> str:
    return text.replace("-", "−")


def unit_of_page(unit: str) -> str:
    """dps/degC^2 as a page has it, dps/°C²."""
    return unit.replace("degC", "°C").replace("^2", "²")


def fixed(value: float, digits: int, sign: str = "") -> str:
    """A number with so many digits behind the point; what rounds to zero has no minus.

    sign: "+" for one before numbers above zero, and zero, too.
    """
    return f"{round(float(value), digits) + 0.0:{sign}.{digits}f}"


def counted(count: int, what: str) -> str:
    """1 device, 2 devices."""
    return f"{count} {what}{'' if count == 1 else 's'}"


def listed(names: Sequence[str], most: int) -> str:
    """The first of them: gx, gy and 3 more."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more


def duration(seconds: float) -> str:
    """As a person would say it: 250 ms, 4.2 s, 15 min, 2.5 h."""
    if seconds < 1:
        return f"{seconds * 1e3:.3g} ms"
    for span, unit in ((86_400, "days"), (3600, "h"), (60, "min")):
        if seconds >= 2 * span:
            return f"{seconds / span:.3g} {unit}"
    return f"{seconds:.3g} s"
