"""Commands, one file each; what they print is printed here and nowhere else in the package."""

COMMANDS = ("shaker", "modes", "sweep", "comfort", "mjcf")
"""Each is a module with `parser()` and `main(arguments)`, and is called as `python -m vehicle NAME`."""
