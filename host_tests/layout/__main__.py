"""`make layout`: writes the constants of layout.py where they are used, and docs/layout.md."""

from pathlib import Path

from .lines import files, refreshed
from .page import page

repository = Path(__file__).resolve().parents[2]
for path in files(repository):
    path.write_text(refreshed(path), encoding="utf-8")
(repository / "docs" / "layout.md").write_text(page(), encoding="utf-8")
