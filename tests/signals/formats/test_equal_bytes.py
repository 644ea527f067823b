"""Equal results are equal files: no format holds the time of writing, the time zone or a name of the moment."""

import time

import pytest

from tests.signals.formats.test_full_disk import WRITERS
from vehicle.drawing.rendering.backend import require_film
from vehicle.errors import MissingPartError
from vehicle.signals.formats.formats import BY_NAME, WRITTEN

COARSEST = 2.0
"""Step of the coarsest clock of a format, in the directory of a ZIP archive [s]."""


@pytest.mark.skipif(not hasattr(time, "tzset"), reason="the time zone of a process is set on Unix only")
def test_each_format_is_equal_at_another_time_in_another_zone(tmp_path, monkeypatch):
    endings = dict(WRITERS)
    try:
        require_film()
    except MissingPartError:
        endings.pop("mp4")
    assert endings.keys() >= set(WRITTEN)
    files = []
    for zone, wait in (("America/New_York", 0.0), ("Asia/Tokyo", COARSEST)):
        time.sleep(wait)  # waiting takes no processor time
        monkeypatch.setenv("TZ", zone)
        time.tzset()
        folder = tmp_path / zone.replace("/", "_")
        folder.mkdir()
        for ending, write in endings.items():
            write(folder / f"time.{ending}")
        files.append({ending: (folder / f"time.{ending}").read_bytes() for ending in endings})
    monkeypatch.undo()
    time.tzset()
    first, second = files
    assert [ending for ending in endings if first[ending] != second[ending]] == []
    # The fixed time of the formats that need one is no start of the record.
    starts = {name: BY_NAME[name].function("reader", "read")(folder / f"time.{name}").start for name in WRITTEN}
    assert not any(starts.values()), starts
