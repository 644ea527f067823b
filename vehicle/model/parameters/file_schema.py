"""JSON Schema (draft 7) of vehicle files and of template files, written from the declarations of their parameters.

A schema checks names, types and ranges, table by table. Relations between parameters, and names that refer to points
and parts, are checked when a car is composed.
"""

import dataclasses
import types
import typing
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from vehicle.model.parameters.air_spring import AIR, AirSpring
from vehicle.model.parameters.applied_force import AppliedForce
from vehicle.model.parameters.body import TrimmedBody
from vehicle.model.parameters.driving import Crank, Driving
from vehicle.model.parameters.engine_orders import ENGINE, ORDERS, EngineOrders
from vehicle.model.parameters.force_elements import (
    DECOUPLER,
    MAXWELL,
    NUMBERS,
    TRACK,
    Bushing,
    Damper,
    Hydromount,
    MainSpring,
    SlideSpring,
    Stabilizer,
    Tyre,
)
from vehicle.model.parameters.further_forces import AXES_OF
from vehicle.model.parameters.hardpoints import LARGEST_M
from vehicle.model.parameters.optional_keys import WITH_FILES
from vehicle.model.parameters.placed_elements import spring_kind
from vehicle.model.parameters.quantity import NAME_PATTERN, type_hints
from vehicle.model.parameters.rigid_part import Load, Part
from vehicle.model.parameters.template import SHIPPED, read_template
from vehicle.model.parameters.template_file import LISTS, TEMPLATE_KEYS, USE_KEYS, read_template_file
from vehicle.model.parameters.topology import RolePart, SteeringAxis, Template, Wheel
from vehicle.model.parameters.vehicle import Head, Solver
from vehicle.model.parameters.wheel_forces import WHEEL_FORCES
from vehicle.names import SIDE_SIGN

Schema = dict[str, Any]

DRAFT = "http://json-schema.org/draft-07/schema#"
KINDS = (
    Part,
    Bushing,
    Tyre,
    Hydromount,
    AirSpring,
    MainSpring,
    SlideSpring,
    Stabilizer,
    Damper,
    *WHEEL_FORCES.values(),
    EngineOrders,
)
"""Parameter classes of the tables of an instance."""

TEXT: Schema = {"type": "string"}
PART: Schema = {**TEXT, "description": "name of a part"}
END: Schema = {
    "type": "object",
    "description": "end stop of a damper: file of the stop, and travel from the design position to the stop [m]",
    "properties": {
        "curve": {
            "type": "string",
            "description": "Adams property file (TeimOrbit), or file with the columns penetration [m] and force [N]",
        },
        "clearance": {
            "type": "number",
            "minimum": 0.0,
            "description": "[m] travel from the design position to the contact",
        },
    },
    "required": ["curve", "clearance"],
    "additionalProperties": False,
}
PLACE: Schema = {"anyOf": [{"$ref": "#/definitions/point"}, {**TEXT, "description": "name of a point"}]}


def vehicle_schema() -> Schema:
    """Return the JSON Schema of a vehicle file.

    Each template of the package has a definition with its points, parts and elements. Instances of other templates
    are checked for what all instances have in common.
    """
    files = sorted(SHIPPED.glob("*.toml"))
    options = {use["when"] for file in files for use in read_template_file(file)["use"] if "when" in use}
    templates = {file.stem: _instance(file, options) for file in files}
    names: Schema = {"properties": {"template": {"enum": [*templates]}}}
    kinds = {
        _name(parameters, complete): _table(parameters, complete) for parameters in KINDS for complete in (True, False)
    }
    return {
        "$schema": DRAFT,
        "title": "Vehicle file",
        "if": {"required": ["base"]},
        "then": {"$ref": "#/definitions/changes"},
        "else": {"$ref": "#/definitions/vehicle"},
        "definitions": {
            "vehicle": _vehicle(complete=True),
            "changes": _vehicle(complete=False),
            "group": {
                "type": "object",
                "if": {"required": ["template"]},
                "then": {"$ref": "#/definitions/instance"},
                "else": {"minProperties": 1, "additionalProperties": {"$ref": "#/definitions/group"}},
            },
            "changed_group": {
                "if": {"type": "object", "required": ["template"]},
                "then": {"$ref": "#/definitions/instance"},
                "else": {"additionalProperties": {"$ref": "#/definitions/changed_group"}},
            },
            "instance": {
                "type": "object",
                "required": ["template"],
                "properties": {"template": {**TEXT, "description": "name of a template, without .toml"}},
                "if": names,
                "then": {
                    "allOf": [
                        {
                            "if": {"properties": {"template": {"const": name}}},
                            "then": {"$ref": f"#/definitions/template_{name}"},
                        }
                        for name in templates
                    ]
                },
                "else": {
                    "properties": {
                        "hardpoints": _mapping(PLACE),
                        "parts": _mapping(_reference(Part)),
                        "ports": _mapping(TEXT),
                    }
                },
            },
            "point": _vector(-LARGEST_M, LARGEST_M),
            **kinds,
            **{f"template_{name}": schema for name, schema in templates.items()},
        },
    }


def template_schema() -> Schema:
    """Return the JSON Schema of a template file."""
    lists: Schema = {key: {"type": "array", "items": _table(parameters)} for key, parameters in LISTS.items()}
    use = _object({key: _value(hint) for key, hint in USE_KEYS.items()}, ["template"])
    pair: Schema = {"type": "array", "items": TEXT, "minItems": 2, "maxItems": 2}
    child = lists["joint"]["items"]["properties"]["child"]
    lists["joint"]["items"]["properties"]["child"] = {"anyOf": [TEXT, child]}  # one part is a list of one
    special: Schema = {
        "use": {"type": "array", "items": use},
        "parts": _mapping(_table(RolePart)),
        "wheel": _table(Wheel),
        "steering_axis": _table(SteeringAxis),
        "above": {"type": "array", "items": {**pair, "description": "the first point is above the second"}},
        **lists,
    }
    properties = {key: special.get(key) or _value(hint) for key, hint in TEMPLATE_KEYS.items()}
    return {"$schema": DRAFT, "title": "Template of a vehicle file", **_object(properties)}


def _vehicle(*, complete: bool) -> Schema:
    """Return the schema of a whole vehicle file, or of a file that changes its base."""
    laws = _table(Tyre)["properties"] | _table(AirSpring)["properties"] | _table(Bushing)["properties"]
    at = {"at": PLACE}
    connection = {
        "moving": PART,
        "carrier": PART,
        **at,
        "ground": {"type": "boolean", "description": "true for a contact that carries the car at rest"},
        "axes": {"type": "array", "items": TEXT, "minItems": 2, "maxItems": 2, "description": "points, x along them"},
    }
    properties: Schema = {
        "base": {**TEXT, "description": "shipped car, or vehicle file beside this one, that this file changes"},
        **_table(Head, complete)["properties"],
        "body": _table(TrimmedBody, complete),
        "solver": _table(Solver, complete),
        "driving": _table(Driving, complete),
        "hardpoints": _mapping({"$ref": "#/definitions/point"}),
        "outputs": _mapping(_object({"on": PART, **at}, ["on", "at"] if complete else [])),
        "connection": _mapping(_object(connection | laws, ["moving", "carrier", "at"] if complete else [])),
        "crank": _table(Crank, complete),
        "force": _mapping(_object(_force_places() | _table(AppliedForce)["properties"])),
        "load": _mapping(_object({**_table(Load)["properties"], "on": PART, **at}, ["mass", "at"] if complete else [])),
        "alias": _mapping({**TEXT, "description": "path of a parameter"}),
    }
    schema = _object(properties, ["name", "gravity", "body", "solver"] if complete else [])
    return {**schema, "additionalProperties": {"$ref": f"#/definitions/{'group' if complete else 'changed_group'}"}}


def _force_places() -> Schema:
    """Return the schema of the keys that place a force of a vehicle file."""
    directions = {key: {**_vector(-1e6, 1e6), "description": f"direction of the {key}"} for key in ("force", "moment")}
    parts = {"on": PART, "against": {**TEXT, "description": "part that receives the opposite force"}}
    return {
        **parts,
        "at": PLACE,
        **directions,
        "axes": {"enum": list(AXES_OF)},
        "joint": {**TEXT, "description": "joint that the torque acts on, instead of the part in `on`"},
    }


def _instance(file: Path, options: Iterable[str]) -> Schema:
    """Return the schema of an instance of a template; points and parts that no option adds are required."""
    template, required = (read_template(file.stem, chosen, ()) for chosen in (options, ()))
    sides = {side: _tables(template, None) for side in SIDE_SIGN} if template.mirrored else {}
    tables = _tables(template, required)["properties"]
    needed = [key for key in ("hardpoints", "parts") if tables[key].get("required")]
    schema = _object({"template": TEXT, **tables, **sides}, needed)
    return {**schema, "additionalProperties": {"$ref": "#/definitions/instance"}}


def _tables(template: Template, required: Template | None) -> Schema:
    """Return the schema of the tables of an instance; `least` None: those of one side, of which none is required."""
    points = {name: {"description": f"[m] {text}", **PLACE} for name, text in template.hardpoints.items()}
    whole = required is not None
    elements: list[tuple[str, type]] = [(spring.name, spring_kind(template, spring)) for spring in template.spring]
    elements += [(damper.name, Damper) for damper in template.damper]
    elements += WHEEL_FORCES.items() if template.wheel is not None else []
    elements += [(ORDERS, EngineOrders)] if ENGINE in template.parts else []
    return _object(
        {
            "hardpoints": _object(points, required.hardpoints if required else ()),
            "parts": _object(
                {name: _reference(Part, whole) for name in template.parts}, required.parts if required else ()
            ),
            "bushings": _object(
                {
                    link.name: _bushing(Tyre if link.carrier == "plate" else Bushing, link.least, whole)
                    for link in template.connection
                }
            ),
            "ports": _object(
                {**{key: {**TEXT, "description": text} for key, text in template.ports.items()}, "body": TEXT}
            ),
            **{name: _reference(parameters, whole) for name, parameters in elements},
        }
    )


def _bushing(parameters: type, lowest_stiffness: float, whole: bool) -> Schema:
    """Return the schema of a connection: a hydromount if a number of its branches is given."""
    branch = {"anyOf": [{"required": [key]} for key in (*MAXWELL, *TRACK, *DECOUPLER)]}
    schema = {"if": branch, "then": _reference(Hydromount, whole), "else": _reference(parameters, whole)}
    air = {"anyOf": [{"required": [key]} for key in AIR]}
    schema = {"if": air, "then": _reference(AirSpring, whole), "else": schema}
    return (
        {**schema, "properties": {"stiffness": {"items": {"minimum": lowest_stiffness}}}}
        if lowest_stiffness
        else schema
    )


def _name(parameters: type, complete: bool) -> str:
    return parameters.__name__ if complete else f"{parameters.__name__}_of_one_side"


def _reference(parameters: type, complete: bool = True) -> Schema:
    return {"$ref": f"#/definitions/{_name(parameters, complete)}"}


def _table(parameters: type[Any], complete: bool = True) -> Schema:
    """Return the schema of a parameter class; complete: fields without a default are required."""
    hints = type_hints(parameters)  # type: ignore[arg-type]
    fields = dataclasses.fields(parameters)
    properties = {entry.name: _field(hints[entry.name], entry, complete) for entry in fields}
    needed = [
        entry.name
        for entry in fields
        if entry.default is dataclasses.MISSING and entry.default_factory is dataclasses.MISSING
    ]
    if parameters not in WITH_FILES:
        schema = _object(properties, needed if complete else [])
        if parameters is Hydromount and complete:
            schema["dependencies"] = {
                **{key: [*keys] for keys in (MAXWELL, TRACK) for key in keys},
                **{key: [*TRACK, *DECOUPLER] for key in DECOUPLER},
            }
        return schema
    # Numbers may be in a file.
    schema = _object(
        {
            **properties,
            "curve": {**TEXT, "description": "file containing the curve, or an Adams property file (TeimOrbit)"},
        }
    )
    if parameters is Damper:
        schema["properties"]["stop"] = {"anyOf": [properties["stop"], _object({"bump": END, "rebound": END})]}
    if not complete:
        return schema
    if parameters is not Damper:
        return {**schema, "anyOf": [{"required": ["curve"]}, {"required": needed}]}
    by_law = [
        {"if": {"properties": {key: {"const": law}}}, "then": {"required": [*NUMBERS[law]]}}
        for key in ("viscous_law", "friction_law")
        for law in properties[key]["enum"]
        if law in NUMBERS
    ]
    return {**schema, "required": needed, "allOf": by_law}


def _field(hint: Any, entry: dataclasses.Field[Any], complete: bool) -> Schema:
    """Return the schema of a field with its unit, meaning and range."""
    declared = entry.metadata
    schema = _value(hint, complete)
    if "unit" not in declared:
        return schema
    limits = {"exclusiveMinimum": "above", "minimum": "at_least", "maximum": "at_most"}
    ranges = {word: declared[key] for word, key in limits.items() if declared[key] is not None}
    if schema["type"] == "array":
        schema["items"] |= ranges
        if declared["length"] is not None:
            schema |= {"minItems": declared["length"], "maxItems": declared["length"]}
    else:
        schema |= ranges
    if declared["choices"]:
        schema["enum"] = [*declared["choices"]]
    elif schema == TEXT and not declared["is_file"]:
        schema["pattern"] = f"^{NAME_PATTERN.pattern}$"
    why = f" ({declared['why']})" if declared["why"] else ""
    schema["description"] = f"[{declared['unit']}] {declared['meaning']}{why}"
    return schema if declared["default"] in (None, ()) else {**schema, "default": declared["default"]}


def _value(hint: Any, complete: bool = True) -> Schema:
    """Return the schema of a type of a field: number, text, boolean, list, table or one of these or None."""
    origin, inner = typing.get_origin(hint), typing.get_args(hint)
    if origin in (types.UnionType, typing.Union):
        return _value(next(option for option in inner if option is not type(None)), complete)
    if origin is tuple:
        return {"type": "array", "items": _value(inner[0], complete)}
    if origin is not None and issubclass(origin, Mapping):
        return _mapping(_value(inner[1], complete))
    if dataclasses.is_dataclass(hint):
        return _table(typing.cast(type[Any], hint), complete)
    return {"type": {float: "number", bool: "boolean", str: "string", dict: "object"}[hint]}


def _vector(low: float, high: float) -> Schema:
    return {"type": "array", "items": {"type": "number", "minimum": low, "maximum": high}, "minItems": 3, "maxItems": 3}


def _mapping(values: Schema) -> Schema:
    return {"type": "object", "additionalProperties": values}


def _object(properties: Schema, required: Iterable[str] = ()) -> Schema:
    schema: Schema = {"type": "object", "properties": properties, "additionalProperties": False}
    return {**schema, "required": needed} if (needed := [*required]) else schema
