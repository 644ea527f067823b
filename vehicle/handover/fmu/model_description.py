"""modelDescription.xml of an FMU, FMI 2.0 and 3.0."""

from collections.abc import Sequence
from xml.sax.saxutils import quoteattr

from vehicle.handover.fmu.variables import UNITS, Variable
from vehicle.version import package_version

IDENTIFIER = "car"
"""Name of the library in the FMU."""

INTERFACE_STEP = 1e-3
"""Suggested communication step [s]."""


def model_description(
    name: str, token: str, entries: Sequence[Variable], *, fmi: str, step: float, description: str
) -> str:
    """Return the text of modelDescription.xml.

    Args:
        token: text that ties it to the resources.
        fmi: "2" or "3".
        step: internal time step [s].
        description: validity of the car and timing of its inputs.
    """
    second = fmi == "2"
    head = {
        "fmiVersion": "2.0" if second else "3.0",
        "modelName": name,
        "guid" if second else "instantiationToken": token,
        "description": description,
        "generationTool": package_version(),
        "variableNamingConvention": "flat",
    }
    state = "State" if not second else "state"
    interface = {
        "modelIdentifier": IDENTIFIER,
        "canHandleVariableCommunicationStepSize": "true",
        f"canGetAndSetFMU{state}": "true",
        f"canSerializeFMU{state}": "true",
    }
    if not second:
        interface["fixedInternalStepSize"] = repr(step)
    units = "".join(
        f"    <Unit{_attributes({'name': unit})}><BaseUnit{_attributes(base)}/></Unit>\n"
        for unit, base in UNITS.items()
        if any(variable.unit == unit for variable in entries)
    )
    multiple = max(round(INTERFACE_STEP / step), 1) * step
    experiment = _attributes({"startTime": "0", "stopTime": "10", "stepSize": f"{multiple:.12g}"})
    variables = "".join(_variable(variable, second) for variable in entries)
    categories = "".join(f'    <Category name="{category}"/>\n' for category in ("logStatusError", "logStatusWarning"))
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f"<fmiModelDescription{_attributes(head)}>\n"
        f"  <CoSimulation{_attributes(interface)}/>\n"
        f"  <UnitDefinitions>\n{units}  </UnitDefinitions>\n"
        f"  <LogCategories>\n{categories}  </LogCategories>\n"
        f"  <DefaultExperiment{experiment}/>\n"
        f"  <ModelVariables>\n{variables}  </ModelVariables>\n"
        f"  <ModelStructure>\n{_structure(entries, second)}  </ModelStructure>\n"
        "</fmiModelDescription>\n"
    )


def _attributes(values: dict[str, object] | dict[str, str] | dict[str, int]) -> str:
    """Return attributes of an element, each after a blank."""
    return "".join(f" {name}={quoteattr(str(value))}" for name, value in values.items())


def _variable(variable: Variable, second: bool) -> str:
    """Return the element of a variable."""
    common: dict[str, object] = {"name": variable.name, "valueReference": variable.reference}
    if variable.meaning:
        common["description"] = variable.meaning
    common |= {"causality": variable.causality, "variability": variable.variability}
    if variable.causality == "parameter":
        common["initial"] = "exact"
    value: dict[str, object] = {} if not variable.unit else {"unit": variable.unit}
    if variable.start is not None:
        value["start"] = repr(variable.start)
    if second:
        return f"    <ScalarVariable{_attributes(common)}><Real{_attributes(value)}/></ScalarVariable>\n"
    return f"    <Float64{_attributes(common | value)}/>\n"


def _structure(entries: Sequence[Variable], second: bool) -> str:
    """Return the outputs, and which of them have a value after initialization."""
    outputs = [(index, variable) for index, variable in enumerate(entries, start=1) if variable.causality == "output"]
    if not second:
        return "".join(
            f'    <{element} valueReference="{variable.reference}"/>\n'
            for element in ("Output", "InitialUnknown")
            for _, variable in outputs
        )
    unknowns = "".join(f'      <Unknown index="{index}"/>\n' for index, _ in outputs)
    return "".join(f"    <{element}>\n{unknowns}    </{element}>\n" for element in ("Outputs", "InitialUnknowns"))
