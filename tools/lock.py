"""Write constraints-hashes.txt: the packages of constraints.txt with the SHA-256 of their published files.

    make tools && .venv/bin/python tools/lock.py

pip refuses hashes beside a requirement without one, so the versions alone stay in constraints.txt. The packages of the
program come first, then those of extras, tests and documentation, then those of `make core` and `make laptop`;
`tools/environment.sh` installs these parts with `--require-hashes`. A line for another system carries its condition.
"""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HASHES = ROOT / "constraints-hashes.txt"
TOOLS = ("uv", "ziglang")


def locked(*requirements: str, extras: tuple[str, ...] = ()) -> dict[str, str]:
    """Return the lines of every package that the program, its extras and other requirements need, by name."""
    command = [sys.executable, "-m", "uv", "pip", "compile", "pyproject.toml", "-", "--generate-hashes", "--universal"]
    command += [
        "--constraint",
        "constraints.txt",
        "--python-version",
        "3.11",
        "--no-header",
        "--no-annotate",
        "--quiet",
    ]
    command += [word for extra in extras for word in ("--extra", extra)]
    given = "\n".join(requirements)
    text = subprocess.run(command, cwd=ROOT, input=given, check=True, capture_output=True, text=True).stdout
    return {block.partition("==")[0]: block for block in re.findall(r"^\S+==.*(?:\n +--hash=.*)+", text, re.MULTILINE)}


def main() -> None:
    """Write the file."""
    build = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["build-system"]["requires"]
    program, tests, tools = locked(*build), locked(*build, extras=("tests",)), locked(*TOOLS)
    parts = {
        "# program": program,
        "# extras, tests, documentation": {name: tests[name] for name in tests if name not in program},
        "# tools": {name: tools[name] for name in tools if name not in tests},
    }
    lines = [line for title, packages in parts.items() for line in (title, *packages.values())]
    HASHES.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print(HASHES.name, *(f"{len(packages)} {title.strip('# ')}" for title, packages in parts.items()), sep=", ")


if __name__ == "__main__":
    main()
