"""Tables of plain text."""

import pytest
from birm3d.base.text_table import aligned


def test_columns_begin_or_end_in_line() -> None:
    rows = [("name", "value", ""), ("a", "10", "remark"), ("long name", "5", "")]
    assert aligned(rows) == ["name       value", "a          10     remark", "long name  5"]
    assert aligned(rows, right=(1,)) == ["name       value", "a             10  remark", "long name      5"]


def test_rows_of_different_lengths_are_refused() -> None:
    with pytest.raises(ValueError, match="zip"):
        aligned([("a", "b"), ("c",)])
