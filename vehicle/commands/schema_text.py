"""`python -m vehicle --schema`: JSON Schema of vehicle files and templates, for editors that check TOML files."""

import json
from collections.abc import Sequence

from vehicle.errors import ConfigurationError


def schema_text(names: Sequence[str]) -> str:
    """Return the JSON Schema "vehicle", the default, or "template" as text."""
    from vehicle.model.parameters.file_schema import template_schema, vehicle_schema

    schemas = {"vehicle": vehicle_schema, "template": template_schema}
    name, *further = names or ["vehicle"]
    if name not in schemas or further:
        raise ConfigurationError(f"--schema {' '.join(names)}: must be one of {', '.join(schemas)}")
    return json.dumps(schemas[name](), indent=2, allow_nan=False)
