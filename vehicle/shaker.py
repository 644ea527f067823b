"""`python -m vehicle.shaker`: the same as `python -m vehicle shaker`."""

from vehicle.commands.shaker import main

if __name__ == "__main__":
    raise SystemExit(main())
