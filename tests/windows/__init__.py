"""The program with CPython for Windows under wine, compared with this system; `make test-windows`."""
