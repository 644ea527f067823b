"""Units of the variables of a controller FMU: x = factor u + offset [SI], with u in the declared unit.

Source: FMI 2.0.4, section 2.2.2, and FMI 3.0.1, section 2.4.3 (definition of units, `BaseUnit`).
"""

import ctypes
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from vehicle.errors import DataError
from vehicle.model.parameters.semi_active_damper import SemiActiveDamper
from vehicle.signals.formats.units import find_unit

EXPONENTS = {"m/s": {"m": 1, "s": -1}, "m/s2": {"m": 1, "s": -2}, "N s/m": {"kg": 1, "s": -1}, "-": dict[str, int]()}
"""Exponents of the SI base units by unit."""

DAMPING = ("N s/m", "N.s/m", "N*s/m", "Ns/m", "kg/s")
"""Spellings of the unit of a damping coefficient without a `BaseUnit`."""

UNITS_OF_CONTROL = {each.name: str(each.metadata["unit"]) for each in fields(SemiActiveDamper)}
"""Unit of each parameter of a controlled damper."""

TRANSFER = ctypes.CFUNCTYPE(
    ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t, ctypes.POINTER(ctypes.c_double), ctypes.c_size_t
)
"""Type of fmi3SetFloat64 and fmi3GetFloat64, and of those of FMI 2.0, which ignore the last argument."""


@dataclass(frozen=True, slots=True)
class Conversion:
    """Conversion of a variable between its declared unit and SI.

    Attributes:
        factor: size of the unit in SI.
        offset: SI value of the value 0.
    """

    factor: float = 1.0
    offset: float = 0.0

    def to_unit(self, value: float) -> float:
        """Return the value of the FMU for a value in SI."""
        return (value - self.offset) / self.factor

    def to_si(self, value: float) -> float:
        """Return the value in SI for a value of the FMU."""
        return self.factor * value + self.offset


def conversion_of(path: Path, variable: Any, description: Any, unit: str) -> Conversion:
    """Return the conversion of a variable; a variable without a unit is in SI.

    Args:
        path: FMU, for messages.
        variable: variable of the model description of FMPy.
        description: model description.
        unit: its unit in SI, a key of `EXPONENTS`.

    Raises:
        DataError: the unit has another dimension, a factor that is not positive, or is not defined and not known.
    """
    declared = variable.unit or (variable.declaredType.unit if variable.declaredType else None)
    if not declared:
        return Conversion()
    base = next((each.baseUnit for each in description.unitDefinitions if each.name == declared), None)
    fault = f"controller {path}: {variable.name} has the unit {declared!r}"
    if base is None:
        spelled = find_unit(declared)
        if spelled is not None and spelled.si == unit:
            return Conversion(spelled.factor)
        if declared == unit or (unit == "N s/m" and declared in DAMPING) or (unit == "-" and declared == "1"):
            return Conversion()
        raise DataError(
            f"{fault} without a BaseUnit in its model description, so its factor to {unit} is not known; define the "
            f"unit there, or export the variable in {unit}"
        )
    exponents = {name: power for name in ("kg", "m", "s", "A", "K", "mol", "cd") if (power := getattr(base, name))}
    if exponents != EXPONENTS[unit] or not base.factor > 0.0:
        powers = " ".join(f"{name}^{power}" for name, power in exponents.items()) or "no dimension"
        raise DataError(f"{fault}, {base.factor:g} {powers}, must be a unit of {unit}; export the variable in {unit}")
    # The offset does not count in differences.
    return Conversion(base.factor, 0.0 if base.offset == 0.0 or _is_relative(path, variable) else base.offset)


def _is_relative(path: Path, variable: Any) -> bool:
    """Return True if a variable or its declared type is a difference (`relativeQuantity`)."""
    if variable.declaredType is not None and variable.declaredType.relativeQuantity:
        return True
    # FMPy 0.3.32 does not read the attribute of a variable.
    with zipfile.ZipFile(path) as archive:
        root = ElementTree.fromstring(archive.read("modelDescription.xml"))
    elements = [each for each in root.iter() if each.get("name") == variable.name and each.get("valueReference")]
    attributes = [part.get("relativeQuantity") for each in elements for part in (each, *each)]
    return any(value in ("true", "1") for value in attributes)


def converting(address: int, conversions: Sequence[Conversion], *, to_fmu: bool) -> Any:
    """Return a function of type `TRANSFER` that converts values and calls the function of an FMU.

    Args:
        address: of the function that sets or gets the values.
        conversions: conversion of each value.
        to_fmu: True for the function that sets them.
    """
    transfer: Callable[..., int] = TRANSFER(address)

    def convert(instance: Any, references: Any, count: int, values: Any, size: int) -> int:
        if to_fmu:
            in_units = [each.to_unit(values[index]) for index, each in enumerate(conversions)]
            return transfer(instance, references, count, (ctypes.c_double * count)(*in_units), size)
        status = transfer(instance, references, count, values, size)
        for index, each in enumerate(conversions):
            values[index] = each.to_si(values[index])
        return status

    return TRANSFER(convert)
