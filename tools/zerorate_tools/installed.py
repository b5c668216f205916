"""How this package came here, and the command that adds one of its extras."""

import json
import sys
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from urllib.parse import urlparse
from urllib.request import url2pathname

#: A file that an installer of commands leaves in the environment that it makes -> its command.
_INSTALLERS = {"pipx_metadata.json": "pipx install --force", "uv-receipt.toml": "uv tool install"}


def adding(extra: str) -> str:
    """Return the command that installs this package again with an extra, ready for a shell.

    It names the wheel or checkout that it was installed from: an index may not have it.
    """
    came_from, editable = _source()
    for left, command in _INSTALLERS.items():
        if (Path(sys.prefix) / left).exists():  # such an environment has no pip of its own
            extras = extra if extra == "tools" else f"tools,{extra}"
            return f"{command} '{came_from}[{extras}]'"
    return f"pip install {'-e ' if editable else ''}'{came_from}[{extra}]'"


def _source() -> tuple[str, bool]:
    """(the file or folder that pip was given, whether it is used in place); else the name."""
    try:
        record = json.loads(distribution("zerorate").read_text("direct_url.json") or "{}")
    except PackageNotFoundError:
        record = {}
    url = urlparse(record.get("url", ""))
    if url.scheme != "file":
        return "zerorate", False
    return url2pathname(url.path), bool(record.get("dir_info", {}).get("editable"))
