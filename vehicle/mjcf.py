"""`python -m vehicle.mjcf`: the same as `python -m vehicle mjcf`."""

from vehicle.commands.mjcf import main

if __name__ == "__main__":
    raise SystemExit(main())
