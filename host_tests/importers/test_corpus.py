"""Logs as other tools write them: right, or refused with words that lead to what is right."""

import pytest
from zerorate_bench.foreign_imports import BY_ITS_WORDS, REFUSED, RIGHT, judged
from zerorate_bench.foreign_logs.corpus import CORPUS

#: What cannot be read, or not without knowing more than the file says.
_REFUSED = {
    *("pickled", "parquet_cut", "database", "spreadsheet", "zip_of_pictures", "zip_of_runs"),
    *("rows_of_numbered_sensors", "gnss_logger", "only_covariances", "ros2_echo", "sketch_lines"),
    *("plotter_lines", "sentences", "offset_counts"),
}


@pytest.mark.parametrize("log", CORPUS, ids=lambda log: log.write.__name__)
def test_a_log_of_another_tool_is_right_or_refused(log):
    row = judged(log)
    accepted = [REFUSED] if log.write.__name__ in _REFUSED else [RIGHT, BY_ITS_WORDS]
    assert row["outcome"] in accepted, row["said"]
