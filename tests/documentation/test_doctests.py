"""The examples in the documentation of the package run and print what they say."""

import doctest
from pathlib import Path

import pytest

import vehicle
from vehicle.model.parameters import channel_words


@pytest.mark.parametrize("module", [vehicle, channel_words], ids=lambda module: module.__name__)
def test_examples_of_a_module(module, tmp_path, monkeypatch):
    pytest.importorskip("pandas")
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("agg")
    monkeypatch.chdir(tmp_path)
    outcome = doctest.testmod(module, optionflags=doctest.ELLIPSIS)
    pyplot.close("all")
    assert outcome.attempted > 1 and outcome.failed == 0
    if module is vehicle:
        assert {path.name for path in Path(tmp_path).iterdir()} >= {"low.html", "low"}
