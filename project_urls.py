"""The URLs in the metadata of wheel and sdist: where the sources were cloned from, if public."""

import re
import subprocess
from pathlib import Path

from hatchling.metadata.plugin.interface import MetadataHookInterface

_PAGES = {
    "Homepage": "",
    "Documentation": "/tree/HEAD/docs",
    "Changelog": "/blob/HEAD/CHANGELOG.md",
    "Issues": "/issues",
}
#: https://host/owner/name, ssh://git@host:22/owner/name, git@host:owner/name; whoever logs in goes.
_REMOTE = re.compile(
    r"(?:https://|ssh://|(?=[^/]+@[^/]+:))(?:[^/@]+@)?"
    r"(?P<host>[\w-]+(?:\.[\w-]+)+)(?::\d+(?=/))?[/:](?P<path>[^\s?#]+?)(?:\.git)?/?"
)


class ProjectUrls(MetadataHookInterface):
    """Sets project.urls for hatchling."""

    def update(self, metadata: dict) -> None:
        metadata["urls"] = urls_of(Path(self.root))


def urls_of(root: Path) -> dict[str, str]:
    """Name -> URL: an sdist's own, else of git's origin; none where it is a folder or missing."""
    if (root / "PKG-INFO").is_file():
        told = re.findall(
            r"^Project-URL: (.+?), (.+)$", (root / "PKG-INFO").read_text("utf-8"), re.M
        )
        return dict(told)
    address = public_address(_origin(root))
    return {name: address + page for name, page in _PAGES.items()} if address else {}


def public_address(remote: str) -> str | None:
    """The page of a repository, from a remote as git has it."""
    found = _REMOTE.fullmatch(remote)
    return f"https://{found['host']}/{found['path']}" if found else None


def _origin(root: Path) -> str:
    """git's remote of this very folder, "" without one: a folder around it is another project."""
    command = ["git", "-C", str(root), "config", "--local", "--get", "remote.origin.url"]
    try:
        if not (root / ".git").exists():
            return ""
        return subprocess.run(command, capture_output=True, text=True, timeout=10).stdout.strip()
    except (OSError, subprocess.TimeoutExpired):
        return ""
