"""`make layout`: the layout's constants where they are used, docs/layout.md and settings.md."""

from pathlib import Path

from .page import files, refreshed

repository = Path(__file__).resolve().parents[2]
for path in files(repository):
    path.write_text(refreshed(path), encoding="utf-8")

from . import page  # noqa: E402  the firmware cannot be imported before its lines are there

(repository / "docs" / "layout.md").write_text(page.page(), encoding="utf-8")
(repository / "docs" / "settings.md").write_text(page.settings_page(repository), encoding="utf-8")
