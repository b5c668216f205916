"""Numbers in which zero has no sign."""


def fixed(value: float, digits: int, sign: str = "") -> str:
    """A number with so many digits behind the point; what rounds to zero has no minus.

    sign: "+" for one before numbers above zero, and zero, too.
    """
    return f"{round(float(value), digits) + 0.0:{sign}.{digits}f}"
