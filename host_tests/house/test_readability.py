"""Every page is in plain English: short sentences of short words."""

from .readability import LEAST_READING_EASE, MOST_WORDS_A_SENTENCE, pages, prose, readability


def test_every_page_reads_easily(repository):
    found = {p: readability((repository / p).read_text("utf-8")) for p in pages(repository)}
    assert len(found) > 25
    hard = {
        page: (words, ease)
        for page, (words, ease) in found.items()
        if words > MOST_WORDS_A_SENTENCE or ease < LEAST_READING_EASE
    }
    assert hard == {}


def test_only_sentences_count():
    page = (
        "# A title\n\nIt takes 3.5 s of [rest](docs/rest.md), says `a.py`:\n\n- one\n- two.\n\n"
        "| table | is |\n|---|---|\n| not | prose |\n\n```python\ncode\n```\n\n![picture](a.png)\n"
    )
    assert prose(page) == "It takes 35 s of rest, says code.\none.\ntwo."


def test_long_sentences_of_long_words_are_hard_to_read():
    hard = "Notwithstanding considerable instrumentation heterogeneity, " * 8 + "it works."
    words, ease = readability(hard)
    assert words > MOST_WORDS_A_SENTENCE and ease < LEAST_READING_EASE
