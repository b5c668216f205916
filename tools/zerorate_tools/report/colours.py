"""The colours of what is shown, by role, which the colour-blind tell apart (Okabe and Ito 2008).

Each role has a colour on light and one on dark ground; where two roles meet in a plot they differ
in lightness or in their mark as well.
"""

#: Role -> colour on light ground, colour on dark ground.
ROLES: dict[str, tuple[str, str]] = {
    "before": ("#8d8d93", "#85858d"),
    "after": ("#0072b2", "#56b4e9"),
    "floor": ("#00795a", "#2fc49b"),
    "heating": ("#c44e00", "#f08a45"),
    "cooling": ("#0072b2", "#56b4e9"),
    "held": ("#8d8d93", "#85858d"),
    "x": ("#0072b2", "#56b4e9"),
    "y": ("#c44e00", "#f08a45"),
    "z": ("#00795a", "#2fc49b"),
    "model": ("#1b1b1f", "#f2f2f4"),
    "context": ("#6c6c74", "#a0a0a8"),
    "event": ("#a8417f", "#e08abf"),
    "long": ("#0072b2", "#56b4e9"),
    "short": ("#d98200", "#e6a532"),
    "any": ("#00795a", "#2fc49b"),
    "now": ("#1b1b1f", "#f2f2f4"),
}
