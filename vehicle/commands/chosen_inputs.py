"""Inputs of a sweep or a search from the command line: files of signals, or roads."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from vehicle.commands.options import read
from vehicle.signals.excitation.road_settings import RoadSettings

if TYPE_CHECKING:
    from vehicle.studies.sweeps.input_choice import InputChoice


def inputs_of(options: argparse.Namespace) -> InputChoice:
    """Return the inputs of parsed options, of which --input, --road, --speed and --seed may be repeated."""
    from vehicle.studies.sweeps.input_choice import InputChoice

    return read(options, InputChoice, settings=read(options, RoadSettings, seed=None))
