"""FMUs of controllers for tests: the library of tests/data/controller behind any model description."""

import zipfile
from collections.abc import Mapping
from pathlib import Path

LIBRARY = Path(__file__).parents[2] / "data" / "controller" / "skyhook.so"
TOKEN = "{skyhook-1}"

NUMBERS = {
    "body_velocity": 0,
    "wheel_velocity": 1,
    "skyhook_damping": 2,
    "minimum_damping": 3,
    "maximum_damping": 4,
    "coefficient": 5,
    "skyhook_share": 6,  # makes the library fail, see `FAULT` in skyhook.c
    "body_acceleration": 7,
    "wheel_acceleration": 8,
    "damper_velocity": 9,
}
"""Value references of the library by the names of the variables."""

INPUTS = ("body_velocity", "wheel_velocity")
PARAMETERS = ("skyhook_damping", "minimum_damping", "maximum_damping")


def controller_fmu(
    path: Path,
    version: str = "2",
    *,
    inputs: tuple[str, ...] = INPUTS,
    output: str = "coefficient",
    parameters: tuple[str, ...] = PARAMETERS,
    references: Mapping[str, int] = NUMBERS,
    token: str = TOKEN,
    platform: str | None = None,
    form: str = "CoSimulation",
    units: Mapping[str, str] | None = None,
    definitions: str = "",
) -> Path:
    """Write an FMU of the skyhook library.

    Args:
        path: file.
        version: of FMI, "2" or "3".
        inputs, output, parameters: names of the variables.
        references: value references by name; that of the coefficient for an unknown name.
        token: text that the library compares.
        platform: folder of the library; that of Linux by default.
        form: type of the FMU.
        units: attributes of variables by name, as 'unit="mm/s"'.
        definitions: elements Unit of the model description.
    """
    causalities = [*((name, "input") for name in inputs), *((name, "parameter") for name in parameters)]
    causalities.append((output, "output"))
    second = version == "2"
    rows = []
    for name, causality in causalities:
        reference = references.get(name, NUMBERS["coefficient"])
        variability = "fixed" if causality == "parameter" else "continuous"
        start = ("" if causality == "output" else ' start="0"') + f" {(units or {}).get(name, '')}"
        head = f'name="{name}" valueReference="{reference}" causality="{causality}" variability="{variability}"'
        rows.append(
            f"<ScalarVariable {head}><Real{start}/></ScalarVariable>" if second else f"<Float64 {head}{start}/>"
        )
    of_output = len(rows) if second else references.get(output, NUMBERS["coefficient"])
    structure = f'<Outputs><Unknown index="{of_output}"/></Outputs>' if second else (
        f'<Output valueReference="{of_output}"/>'
    )  # fmt: skip
    identity = f'fmiVersion="{version}.0" modelName="skyhook" ' + (
        f'guid="{token}"' if second else f'instantiationToken="{token}"'
    )
    text = (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<fmiModelDescription {identity}><{form} modelIdentifier="skyhook"/>'
        f"{definitions and f'<UnitDefinitions>{definitions}</UnitDefinitions>'}"
        f"<ModelVariables>{''.join(rows)}</ModelVariables><ModelStructure>{structure}</ModelStructure>"
        "</fmiModelDescription>"
    )
    folder = platform or ("linux64" if second else "x86_64-linux")
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", text)
        ending = "dll" if folder.startswith("win") else "so"
        archive.write(LIBRARY, f"binaries/{folder}/skyhook.{ending}")
    return path
