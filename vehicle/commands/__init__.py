"""Commands, a file or a folder each; what they print is printed here and nowhere else in the package."""

COMMANDS = (
    "shaker",
    "modes",
    "sweep",
    "comfort",
    "mjcf",
    "show",
    "kinematics",
    "road",
    "inspect",
    "loads",
    "spectra",
    "levels",
    "orders",
    "body",
    "compare",
    "report",
    "drive",
    "optimise",
    "tune",
    "diagnose",
    "fit-mount",
    "fit-damper",
    "new",
    "fmu",
    "bench",
    "trust",
)
"""Each is a module with `parser()` and `main(arguments)`, and is called as `python -m vehicle NAME`."""


def module_of(name: str) -> str:
    """Return the name of the module of a command."""
    return f"vehicle.commands.{name.replace('-', '_')}"


OLDER = ("shaker", "modes", "comfort")
"""Those that are called as `python -m vehicle.NAME` too."""
