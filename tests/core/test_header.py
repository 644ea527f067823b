"""Lists in the headers of the core, as a compiler reads them."""

import pytest

from vehicle.core import header


@pytest.mark.parametrize(
    "text",
    [
        "#define EACH(F) \\\n  F(one, a) \\\n  F(two, b)\n",
        "#define EACH(F) \\  \n  F(one, a) \\\n  F( two , b )\n",
        "# define EACH(F) /* F(old, x) */ F(one, a) F(two, b) // F(other, y)\n",
    ],
    ids=["usual", "blanks", "comments"],
)
def test_entries_of_a_list(text, tmp_path, monkeypatch):
    (tmp_path / "made.h").write_text(text, encoding="utf-8")
    monkeypatch.setattr(header, "SOURCES", tmp_path)
    header._text.cache_clear()
    assert header.listed("made.h", "EACH", "F") == [("one", "a"), ("two", "b")]
    with pytest.raises(KeyError, match=r"made\.h has no line '#define ALL\(F\)'"):
        header.listed("made.h", "ALL", "F")
    header._text.cache_clear()
