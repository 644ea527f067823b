"""Controllers of semi-active dampers: one FMU for all dampers of a car, and the trust in their native code."""

from pathlib import Path

from vehicle.core.trusted_code import trust
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.model.parameters.quantity import PATH_PATTERN
from vehicle.model.parameters.semi_active_damper import FMU


def with_controller(car: CarChoice, controller: Path | None, *, trusted: bool) -> CarChoice:
    """Return the choice of a car whose semi-active dampers have an FMU as their controller.

    Args:
        controller: FMU of all semi-active dampers; None keeps those of the car.
        trusted: allow the native code of the FMUs from now on.

    Raises:
        ConfigurationError: no damper has an FMU or can have one, the FMU does not exist, or its path cannot be
            written in a vehicle file.
    """
    if controller is None and not trusted:
        return car
    vehicle = car.load()
    controls = {damper.path: control for damper in vehicle.composition.dampers if (control := damper.law.control)}
    if controller is None:
        files = {path: Path(control.fmu) for path, control in controls.items() if control.law == FMU and control.fmu}
        files = {path: file for path, file in files.items() if file.is_file()}
        if not files:
            raise ConfigurationError(
                f"--trust: no damper of {vehicle.name} is controlled by an FMU; leave --trust out, or add "
                "--controller FILE"
            )
        return car.with_("--trust", *(f"{path}.control.fmu_sha256={trust(file)}" for path, file in files.items()))
    if not controls:
        raise ConfigurationError(
            f"--controller {controller}: {vehicle.name} has no semi-active damper; use --vehicle "
            "focus_road, or add a section [front.damper.control] to the vehicle file (docs/vehicle-file.md)"
        )
    if trusted and not controller.is_file():
        raise ConfigurationError(f"--controller {controller}: the file does not exist; give the path of an FMU")
    file = controller.resolve().as_posix()
    if not PATH_PATTERN.fullmatch(file):
        raise ConfigurationError(
            f"--controller {file}: the path contains a quotation mark, bracket, # or backslash, which vehicle "
            "files do not allow; rename or move the FMU"
        )
    texts = [f"law={FMU}", f"fmu={file}", *([f"fmu_sha256={trust(controller)}"] if trusted else [])]
    return car.with_("--controller", *(f"{path}.control.{text}" for path in controls for text in texts))
