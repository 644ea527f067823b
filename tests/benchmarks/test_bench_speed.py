"""The bench follows a slider, and its benchmark runs; times are compared within a run, not judged."""

import time

import pytest

from tests.benchmarks.bench_speed import frame_ms, numbers_ms
from vehicle import read_signal
from vehicle.handover.bench.drive import SECONDS, bench_drive
from vehicle.handover.bench.numbers import numbers
from vehicle.runs.car import Car
from vehicle.signals.excitation.input_files import find_input


def test_numbers_follow_a_slider_faster_than_a_car_is_made():
    """A changed parameter reuses the matrices of the car: less time than the car takes from its file."""
    changed = numbers_ms("focus", on_road=False, repeats=3)
    drive = bench_drive(Car.load("focus"), read_signal(find_input("high.csv"), wheel="fl"), seconds=SECONDS)
    began = time.thread_time()
    numbers(Car.load("focus"), drive)
    assert 0.0 < changed < 1e3 * (time.thread_time() - began)


@pytest.mark.parametrize(("name", "picture"), [("focus", "run"), ("focus", "mode"), ("focus_road", "obstacle")])
def test_frames_are_sent_to_a_window(name, picture):
    pytest.importorskip("viser", reason="viser is missing: pip install 'vehicle-on-shaker[bench]'")
    rate, cost = frame_ms(name, picture, 0.3)
    assert rate > 0.0 and cost > 0.0
