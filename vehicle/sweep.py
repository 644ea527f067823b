"""`python -m vehicle.sweep`: the same as `python -m vehicle sweep`."""

from vehicle.commands.sweep import main

if __name__ == "__main__":
    raise SystemExit(main())
