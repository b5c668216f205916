"""The site's search: pages of figures come behind those that explain."""


def on_page_markdown(markdown, page, **others):
    """MkDocs calls it for each page: those below Figures, and the list of words, count less."""
    menu = page.parent.title if page.parent else ""
    if menu == "Figures" or page.file.src_uri == "layout.md":
        page.meta["search"] = {"boost": 0.1}
    return markdown
