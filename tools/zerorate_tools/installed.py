"""How this package came here, and the commands that add to it."""

import json
import sys
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from urllib.parse import urlparse
from urllib.request import url2pathname

#: A file that an installer of commands leaves in the environment that it makes -> its commands:
#: one installs this package again, one another package beside it. pip is not in such a one.
_INSTALLERS = {
    "pipx_metadata.json": ("pipx install --force", "pipx inject zerorate"),
    "uv-receipt.toml": ("uv tool install", f"uv pip install --python '{sys.prefix}'"),
}


def adding(extra: str) -> str:
    """Return the command that installs this package again with an extra, ready for a shell.

    It names the wheel or checkout that it was installed from: an index may not have it.
    """
    came_from, editable = _source()
    if commands := _commands():
        extras = extra if extra == "tools" else f"tools,{extra}"
        return f"{commands[0]} '{came_from}[{extras}]'"
    return f"pip install {'-e ' if editable else ''}'{came_from}[{extra}]'"


def beside(package: str) -> str:
    """Return the command that installs another package into the environment of this one."""
    commands = _commands()
    return f"{commands[1] if commands else 'pip install'} {package}"


def _commands() -> tuple[str, str] | None:
    here = Path(sys.prefix)
    return next((both for left, both in _INSTALLERS.items() if (here / left).exists()), None)


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
