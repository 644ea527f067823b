"""Text of a new vehicle file: behind each number its unit and where it comes from."""

from collections.abc import Mapping
from typing import Any

from vehicle.model.parameters.toml_file import write_text
from vehicle.model.parameters.vehicle import Vehicle


def vehicle_text(
    vehicle: Vehicle, header: str, sources: Mapping[str, str], template: str, before: Mapping[str, str]
) -> str:
    """Return the text of a vehicle file whose comments contain unit and source of each value.

    Args:
        header: first lines, without the comment sign.
        sources: source by path, of the values that are not the template's.
        before: source by path in the file of the template, see `value_sources`.
    """

    def describe(path: str) -> dict[str, Any]:
        unit = vehicle.quantity_of(path).get("unit", "-")
        parents = [path.rsplit(".", count)[0] for count in range(path.count(".") + 1)]
        if source := next((sources[parent] for parent in parents if parent in sources), None):
            return {"unit": unit, "meaning": source}
        earlier = next((before[parent] for parent in parents if parent in before), "")
        return {"unit": unit, "meaning": f"template {template}" + (f": {earlier}" if earlier else "")}

    return write_text(vehicle, header, describe)
