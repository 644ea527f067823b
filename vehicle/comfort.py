"""`python -m vehicle.comfort`: the same as `python -m vehicle comfort`."""

from vehicle.commands.comfort import main

if __name__ == "__main__":
    raise SystemExit(main())
