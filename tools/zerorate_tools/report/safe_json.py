"""JSON that can stand inside a page's <script> whatever is in it."""

import json
from typing import Any

_UNSAFE = {ord(c): f"\\u{ord(c):04x}" for c in "<>&\u2028\u2029'"}


def script_json(value: Any) -> str:
    """JSON without any character that could end the element, begin a comment or break a line."""
    text = json.dumps(value, allow_nan=False, separators=(",", ":"), ensure_ascii=False)
    return text.translate(_UNSAFE)
