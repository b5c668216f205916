"""docs/data-way.svg: the way of a sample on the board, and of a recording through the loop."""

from html import escape

_WIDTH, _HEIGHT = 940, 400
_STYLE = """
  text { font: 13px system-ui, sans-serif; fill: #1b1b1f; text-anchor: middle }
  .small { font-size: 11px; fill: #55555c } .side { text-anchor: start; font-weight: 600 }
  rect { fill: #f4f6fa; stroke: #0072b2; stroke-width: 1.3 } .band { fill: none; stroke: #b9b9c0;
  stroke-dasharray: 4 4 } path { fill: none; stroke: #55555c; stroke-width: 1.4 }
  .found path { stroke: #c44e00; stroke-width: 2 } marker path { fill: #55555c; stroke: none }
  .found .tip, #found path { fill: #c44e00; stroke: none }
  @media (prefers-color-scheme: dark) {
    text { fill: #f2f2f4 } .small { fill: #b4b4bc } rect { fill: #22252b; stroke: #56b4e9 }
    path { stroke: #b4b4bc } .found path { stroke: #f08a45 } marker path { fill: #b4b4bc }
    #found path { fill: #f08a45 } }
"""
#: name, second line, centre x, centre y, width
_BOXES = (
    ("chip", "MPU-6050 family", 75, 92, 110),
    ("driver", "zerorate_i2c", 205, 92, 100),
    ("guard", "a real reading?", 328, 92, 106),
    ("effects", "what the loop found", 462, 92, 122),
    ("stillness", "still or moving?", 598, 92, 110),
    ("estimators", "bias over temperature", 738, 92, 130),
    ("corrector", "one bias an axis", 868, 92, 106),
    ("recording", "CSV or Parquet", 205, 300, 110),
    ("replay", "the same firmware", 345, 300, 118),
    ("close", "what is left, and why?", 520, 300, 140),
    ("report.html", "how good, what, how sure", 738, 284, 160),
    ("model.bin", "the effects, as data", 738, 342, 140),
)
_ARROWS = (
    *(
        "M130 92 H152",
        "M255 92 H272",
        "M381 92 H398",
        "M523 92 H540",
        "M653 92 H670",
        "M803 92 H812",
    ),
    *("M205 114 V275", "M75 300 H147", "M260 300 H283", "M404 300 H447"),
    *("M590 294 L655 286", "M590 308 L665 334"),
)
_FOUND = "M808 342 H880 V206 H462 V117"
_WORDS = (
    ("your program gets the sample, its bias taken off", 728, 150, "small"),
    ("zerorate record", 254, 200, "small"),
    ("other logs:", 60, 288, "small"),
    ("zerorate import", 66, 318, "small"),
    ("back to the board: flash, or a line of code", 610, 198, "small"),
)


def data_way():
    """The drawing as SVG text; it follows the reader's light or dark setting."""
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img" '
        'aria-label="The way of a sample on the board and of a recording through the loop">',
        f"<style>{_STYLE}</style>",
        _marker("arrow") + _marker("found"),
        '<rect class="band" x="10" y="30" width="920" height="138" rx="8"/>',
        '<rect class="band" x="10" y="236" width="920" height="155" rx="8"/>',
        _text(
            "on the board: 14 bytes in, the same sample corrected, integers only", 22, 50, "side"
        ),
        _text(
            "on a host: what remains is measured, traced to an effect, and sent back",
            220,
            256,
            "side",
        ),
        *(_box(*box) for box in _BOXES),
        *(f'<path d="{way}" marker-end="url(#arrow)"/>' for way in _ARROWS),
        f'<g class="found"><path d="{_FOUND}" marker-end="url(#found)"/></g>',
        '<path d="M868 114 V146 H892" marker-end="url(#arrow)"/>',
        *(_text(*words) for words in _WORDS),
        "</svg>\n",
    ]
    return "\n".join(parts)


def _marker(name):
    return (
        f'<marker id="{name}" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" '
        'orient="auto-start-reverse"><path d="M0 0 L8 4 L0 8 z"/></marker>'
    )


def _box(name, second, x, y, width):
    left, top = x - width / 2, y - 22
    return (
        f'<rect x="{left:g}" y="{top:g}" width="{width}" height="44" rx="6"/>'
        + _text(name, x, y - 3)
        + _text(second, x, y + 13, "small")
    )


def _text(words, x, y, kind=""):
    return f'<text x="{x}" y="{y}" class="{kind}">{escape(words)}</text>'
