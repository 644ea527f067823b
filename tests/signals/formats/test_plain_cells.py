"""Tables that leave the program: no cell that a spreadsheet would compute, in rows, heads and comments."""

import csv
import io

import numpy as np
import pytest

from vehicle.signals.formats.csv_table import RowWriter, comment_line, plain_cell, read_texts, table_text, write_table

FORMULAS = ['=HYPERLINK("http://x","y")', "+cmd|' /C calc'!A0", "-2+3+cmd", "@SUM(A1)", "\t=1+1", "-20 % soft"]
NUMBERS = ["-1.5", "+2", "-1e-3", "12", "seat rail", "", "a=b"]


@pytest.mark.parametrize("text", FORMULAS)
def test_a_formula_is_text_and_is_read_back_as_written(text, tmp_path):
    file = tmp_path / "table.csv"
    file.write_text(table_text([["case", "value"], [text, 1.0]]), encoding="utf-8")
    (cell, _) = next(row for row in csv.reader(io.StringIO(file.read_text())) if row[0] != "case")
    assert cell == f"'{text}"
    assert read_texts(file)[1] == [text, "1"]


def test_numbers_and_words_stay_as_they_are():
    assert [plain_cell(cell) for cell in [*NUMBERS, -3.5, None]] == [*NUMBERS, -3.5, None]
    file = io.StringIO()
    RowWriter(file).writerow([*NUMBERS, -2.5])
    assert file.getvalue() == "-1.5,+2,-1e-3,12,seat rail,,a=b,-2.5\n"


def test_heads_and_comments_hold_no_formula(tmp_path):
    write_table(tmp_path / "x.csv", ["time [s]", "=A1 [m]"], [np.zeros(2), np.ones(2)], ["file a,=B1\n=C1, -3 dB"])
    assert (tmp_path / "x.csv").read_text().splitlines()[:2] == ["# file a, =B1 =C1, -3 dB", "time [s],'=A1 [m]"]
    assert comment_line("a;@x") == "# a; @x"
