"""`make layout`: the layout's constants where they are used, docs/layout.md and settings.md."""

from pathlib import Path

from .lines import files, refreshed
from .page import page
from .settings_page import settings_page

repository = Path(__file__).resolve().parents[2]
for path in files(repository):
    path.write_text(refreshed(path), encoding="utf-8")
(repository / "docs" / "layout.md").write_text(page(), encoding="utf-8")
(repository / "docs" / "settings.md").write_text(settings_page(repository), encoding="utf-8")
