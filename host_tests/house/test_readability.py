"""The pages for newcomers are in plain English: short sentences of short words."""

import pytest

from .readability import LEAST_READING_EASE, MOST_WORDS_A_SENTENCE, PAGES, prose, readability


@pytest.mark.parametrize("page", PAGES)
def test_a_page_for_newcomers_reads_easily(page, repository):
    words, ease = readability((repository / page).read_text(encoding="utf-8"))
    assert words <= MOST_WORDS_A_SENTENCE
    assert ease >= LEAST_READING_EASE


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
