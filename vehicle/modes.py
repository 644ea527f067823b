"""`python -m vehicle.modes`: the same as `python -m vehicle modes`."""

from vehicle.commands.modes import main

if __name__ == "__main__":
    raise SystemExit(main())
