"""Unpack arrays of HDF5 and netCDF by their attributes: x = scale_factor * packed + add_offset, and missing values.

Sources: CF conventions 1.11, sections 2.5.1 and 8.1; NetCDF User Guide, attribute conventions (`valid_range`,
`_Unsigned`); NWB, TimeSeries (`conversion`, `offset`).
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehicle.arrays import Mask

SCALINGS = (("scale_factor", "add_offset"), ("conversion", "offset"))
"""Attributes of factor and offset: CF conventions, NWB. `add_offset` needs no factor, `offset` needs one."""

UNKNOWN_SCALINGS = ("gain", "scale", "scaling", "factor", "slope", "multiplier", "calibration", "sensitivity", "lsb")
"""Names of attributes that possibly scale the values; no convention defines their meaning."""

SET_BY_USER = 2
"""HDF5 state of a fill value that the program set (H5D_FILL_VALUE_USER_DEFINED); netCDF sets it for missing samples."""


def unpacked(name: str, dataset: Any) -> tuple[NDArray[Any], str, tuple[str, ...]]:
    """Read an array and unpack it.

    Returns:
        Values, NaN for missing values, shape of the array; the reason why the unit is wrong for them, empty if it is
        right; and notices.
    """
    packed = np.asarray(dataset[()])
    attributes = dataset.attrs
    if attribute_text(attributes.get("_Unsigned")).lower() == "true" and packed.dtype.kind == "i":
        packed = packed.view(packed.dtype.str.replace("i", "u"))
    values = packed.astype(complex if packed.dtype.kind == "c" else np.float64)
    factor, offset, notices, fault = 1.0, 0.0, [], ""
    for scale, shift in SCALINGS:
        if scale in attributes or (shift in attributes and shift == "add_offset"):
            numbers = [np.asarray(attributes.get(key, neutral)) for key, neutral in ((scale, 1.0), (shift, 0.0))]
            if any(number.size != 1 or number.dtype.kind not in "fiu" for number in numbers):
                fault = f"attribute {scale} or {shift} is not a single number"
            else:
                factor, offset = (float(number.reshape(-1)[0]) for number in numbers)
            break
    if not fault and packed.dtype.kind in "iu":
        fault = next((
            f"attribute {key!r} = {attributes[key]} may scale the integers in an unknown way"
            for key in attributes
            if key.lower() in UNKNOWN_SCALINGS and not np.array_equal(np.ravel(attributes[key]), [1.0])
        ), "")  # fmt: skip
    if (factor, offset) != (1.0, 0.0):
        values = values * factor + offset
        notices.append(f"array {name!r}: integers are converted by its factor {factor:g} and offset {offset:g}")
    if packed.dtype.kind in "fiu":
        missing = _missing(dataset, packed, values)
        if missing.any():
            notices.append(f"array {name!r}: {np.count_nonzero(missing)} values are marked as missing")
            values[missing] = np.nan
    return values, fault, tuple(notices)


def _missing(dataset: Any, packed: NDArray[Any], values: NDArray[Any]) -> Mask:
    """Return the mask of missing values: equal to a fill value, or outside the valid range.

    The valid range is in packed values, except if it has the type of wider, unpacked values (NetCDF User Guide).
    """
    attributes = dataset.attrs

    def stored(name: str) -> list[Any]:
        """Return the numbers of an attribute; of the type of packed integers that `_Unsigned` makes unsigned."""
        numbers = np.ravel(attributes.get(name, []))
        if packed.dtype.kind == "u" and numbers.dtype.kind == "i" and numbers.dtype.itemsize == packed.dtype.itemsize:
            numbers = numbers.view(packed.dtype)
        return numbers.tolist() if numbers.dtype.kind in "fiu" else []

    fills = [*stored("_FillValue"), *stored("missing_value")]
    properties = dataset.id.get_create_plist()
    if properties.fill_value_defined() == SET_BY_USER and dataset.fillvalue != 0:
        fills += np.ravel(np.asarray(dataset.fillvalue, dtype=dataset.dtype).astype(packed.dtype)).tolist()
    missing = np.zeros(packed.shape, dtype=bool)
    for fill in fills:
        if packed.dtype.kind == "f":
            missing |= packed == np.float64(fill).astype(packed.dtype)
        else:
            missing |= (packed == fill) | (values == fill if isinstance(fill, float) else False)
    span = sorted(stored("valid_range"))
    for low, high in ((span[:1], span[1:]), (stored("valid_min"), []), ([], stored("valid_max"))):
        for limits, sign in ((low, 1.0), (high, -1.0)):
            for limit in limits[:1]:
                scaled = packed.dtype.kind in "iu" and isinstance(limit, float)
                missing |= sign * (values if scaled else packed.astype(np.float64)) < sign * limit
    return missing


def attribute_text(value: Any) -> str:
    """Return an attribute as text, also of an array of length one; empty for a missing attribute."""
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.reshape(-1)[0]
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else "" if value is None else str(value)
