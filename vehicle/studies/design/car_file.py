"""Text of a new vehicle file: behind each number its unit and where it comes from."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from vehicle.model.parameters.base_car import base_file
from vehicle.model.parameters.toml_file import write_text
from vehicle.model.parameters.vehicle import Vehicle

TABLE = re.compile(r"\s*\[([^\[\]]+)\]\s*(#.*)?$")
VALUE = re.compile(r"\s*([A-Za-z0-9_-]+)\s*=\s*(?:\"[^\"]*\"|[^#\"]|\"[^\"]*\")*#\s*(?:\[[^\]]*\]\s*)?(.+?)\s*$")


def sources_of(file: Path) -> dict[str, str]:
    """Return the comment behind each value of a vehicle file, by the path of the value.

    A file with a base has the comments of the base where it has none. Values over several lines have none.

    Args:
        file: path of a vehicle file.
    """
    base = base_file(file)
    sources = {} if base is None else sources_of(base)
    table = ""
    for line in file.read_text(encoding="utf-8").splitlines():
        if match := TABLE.match(line):
            table = f"{match[1].strip()}."
        elif match := VALUE.match(line):
            sources[f"{table}{match[1]}"] = match[2]
    return sources


def vehicle_text(
    vehicle: Vehicle, header: str, sources: Mapping[str, str], template: str, before: Mapping[str, str]
) -> str:
    """Return the text of a vehicle file whose comments contain unit and source of each value.

    Args:
        vehicle: the new car.
        header: first lines, without the comment sign.
        sources: source by path, of the values that are not the template's.
        template: name of the template car.
        before: source by path in the file of the template, see `sources_of`.
    """

    def describe(path: str) -> dict[str, Any]:
        unit = vehicle.quantity_of(path).get("unit", "-")
        parents = [path.rsplit(".", count)[0] for count in range(path.count(".") + 1)]
        if source := next((sources[parent] for parent in parents if parent in sources), None):
            return {"unit": unit, "meaning": source}
        earlier = next((before[parent] for parent in parents if parent in before), "")
        return {"unit": unit, "meaning": f"template {template}" + (f": {earlier}" if earlier else "")}

    return write_text(vehicle, header, describe)
