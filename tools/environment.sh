#!/usr/bin/env bash
# environment.sh PYTHON VENV [tests]: makes the virtual environment, installs the locked dependencies whose files have
# the SHA-256 of constraints-hashes.txt (with "tests" those of all extras as well), and the package itself.
# environment.sh PYTHON VENV tools: adds the compiler and the installer that `make core` and `make laptop` need.
set -euo pipefail
python=$1
venv=$2
part=${3:-}
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
  || { echo "needed is Python 3.11 or newer, found $("$python" --version); set PYTHON=/path/to/python3.11"; exit 2; }
[ -x "$venv/bin/python" ] || "$python" -m venv "$venv"
# Python compiles a module when it is first imported; pip would compile all, of which a run imports a part.
install() {
  "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-compile --no-deps "$@" \
    2> >(grep -v '^WARNING' >&2)
}
locked() {
  case $part in
    tools) sed -n '/^# tools/,$p' constraints-hashes.txt ;;
    tests) sed '/^# tools/q' constraints-hashes.txt ;;
    *) sed '/^# extras/q' constraints-hashes.txt ;;
  esac
}
install --require-hashes --requirement <(locked)
# setuptools is among the locked packages, so pip need not fetch another one to build the package.
[ "$part" = tools ] || install --no-build-isolation --editable ".${part:+[$part]}"
