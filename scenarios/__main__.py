"""`python -m scenarios`: all studies, a line each."""

from scenarios.study import STUDIES


def main() -> int:
    """Print the list; returns the exit code."""
    print("python -m scenarios.NAME [--quick] [--help]\n")
    for name, line in STUDIES.items():
        print(f"{name:<20} {line}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
