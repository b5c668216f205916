"""docs/settings.md: what a user may set, made from firmware/zerorate/settings.py."""

import ast
import re

from zerorate.settings import DEFAULTS, LEAST, MOST, OF_THE_DOCUMENT

_ENTRY = re.compile(r'^    "(\w+)": [-\w.]+,  # (.+)$', re.MULTILINE)
_CONSTANT = re.compile(r"^_(\w+) = const\((\w+)\)  # (.+)$", re.MULTILINE)

_HEAD = """# What a user may set

Made from `firmware/zerorate/settings.py` by `make layout`; edit that file. Give any of them by
name: `Corrector(sensor, still_dps=0.5)`. The unit is behind the last `_`. A time of readings, as
`promote_s`, is as many readings as the output data rate gives in it. The words that a setting
makes are in [layout.md](layout.md). Outside of its range `Corrector` raises ValueError; within
them, and within those of `Sensor`, nothing leaves 31 bits (`make sweep`). A window has a power of
two samples, 4 to 256, as near to `window_s` as it gets. A segment has at most eight windows. At
100 Hz a segment of 2.5 s is 2.56 s long.

To change one for good, edit `DEFAULTS` there and run `make layout`.

`zerorate close` honours none of them: it computes with the defaults below, whatever the device
used. `zerorate_tools.replay` takes any of them by name.
"""
_FIXED = """## What is not set but fixed

In `firmware/zerorate/rest/stillness.py`, with the rules that decide that a window is still, and how
its temperature is followed:
"""


def settings_page(repository):
    """Return the page's text."""
    firmware = repository / "firmware" / "zerorate"
    source = (firmware / "settings.py").read_text(encoding="utf-8")
    meanings, words = dict(_ENTRY.findall(source)), words_made(source)
    rows = [
        "| setting | default | by the document | at least | at most | what | makes |",
        "|---|---|---|---|---|---|---|",
    ]
    for name, value in DEFAULTS.items():
        made = ", ".join(f"`{word}`" for word in words.get(name, ()))
        literal = OF_THE_DOCUMENT.get(name, "")
        least, most = LEAST.get(name, 0), MOST[name.split("_")[-1]]
        limits = f"{least:g} | {most:g}"
        rows.append(f"| `{name}` | {value} | {literal} | {limits} | {meanings[name]} | {made} |")
    fixed = ["| constant | value | what |", "|---|---|---|"]
    stillness = (firmware / "rest" / "stillness.py").read_text(encoding="utf-8")
    white = re.search(r"([\d.]+ to [\d.]+) times is taken for noise", stillness)
    fixed.append(
        f"| in `white` | {white[1]} | steps of samples, squared, for their variance: noise |"
    )
    lean = re.search(r"# (.+)\n_LEAN_NOISE = const\((\d+)\)", source)
    fixed.append(f"| `LEAN_NOISE` in settings.py | {lean[2]} | {lean[1]} |")
    for name, value, meaning in _CONSTANT.findall(stillness):
        fixed.append(f"| `{name}` | {value} | {meaning.rstrip(':')} |")
    return "\n".join([_HEAD, *rows, "", _FIXED, *fixed, ""])


def words_made(source):
    """Return setting -> the words of the kernels' settings that it makes, by way of locals too."""
    found, through = {}, {}
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Assign):
            continue
        value = ast.unparse(node.value)
        names = re.findall(r"limits\['(\w+)'\]", value)
        for local in set(re.findall(r"\w+", value)) & set(through):
            names += through[local]
        for target in node.targets:
            if isinstance(target, ast.Name) and names and target.id != "c":
                through[target.id] = names
            if isinstance(target, ast.Subscript):
                for name in names:
                    found.setdefault(name, []).append(target.slice.id[1:])
    return found
