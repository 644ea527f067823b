"""Keys of the cases of a sweep: a stored row is used again only for an equal case, measure and program."""

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from vehicle.model.flexbody.body_model import PACKAGE_FOLDER
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.template import SHIPPED as TEMPLATES
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.studies.sweeps.case import Case, Input, digest
from vehicle.studies.sweeps.measure import Measure
from vehicle.studies.sweeps.program import class_source, program_digest

KEY_DIGITS = 20
"""Hexadecimal digits of a key: 80 bit, so ten million rows have two equal keys with a probability of 4e-11."""


class CaseKeys:
    """Function of a case that returns a digest of all data that its values depend on.

    These data are car, input, engine, measure and program.
    """

    def __init__(self, measure: Measure) -> None:
        self._common = digest([program_digest(), repr(measure), class_source(measure)])
        # Thousands of cases share a few inputs and cars; reading them for every case would take half a minute.
        self._inputs: dict[int, tuple[Input, str]] = {}
        self._cars: dict[Path | None, str] = {}
        self._begun: dict[tuple[Path | None, int, str], Any] = {}

    def __call__(self, case: Case) -> str:
        """Return the key of a case.

        Raises:
            ConfigurationError, DataError: the input or the vehicle file cannot be read.
        """
        shared = (case.vehicle, id(case.source), case.engine)
        begun = self._begun.get(shared)
        if begun is None:
            texts = [self._common, self._car(case.vehicle), self._input(case.source), case.engine]
            begun = self._begun[shared] = hashlib.sha256(repr(texts).encode())
        content = begun.copy()
        content.update(repr((case.shared, case.overrides)).encode())
        return str(content.hexdigest()[:KEY_DIGITS])

    def _input(self, source: Input) -> str:
        if id(source) not in self._inputs:
            # The input is stored too, so that its id belongs to no other object.
            self._inputs[id(source)] = source, digest(source.identity())
        return self._inputs[id(source)][1]

    def _car(self, vehicle: Path | None) -> str:
        if vehicle not in self._cars:
            self._cars[vehicle] = _car_digest(vehicle)
        return self._cars[vehicle]


def case_keys(cases: Sequence[Case], measure: Measure) -> list[str]:
    """Return the key of each case, see `CaseKeys`."""
    return list(map(CaseKeys(measure), cases))


def _car_digest(vehicle: Path | None) -> str:
    """Return a digest of a vehicle file and of all superelements and templates that it may refer to."""
    file = FOCUS_FILE if vehicle is None else vehicle
    load_vehicle(file)  # raises the usual error for a bad file
    content = hashlib.sha256(file.read_bytes())
    for folder in dict.fromkeys([file.parent, file.parent / "templates", PACKAGE_FOLDER, TEMPLATES]):
        for path in sorted(folder.glob("*.toml")):
            content.update(path.name.encode() + path.read_bytes())
    return content.hexdigest()[:20]
