#!/usr/bin/env bash
# Installs what pip cannot, on Debian, as root: the off-screen OpenGL library (OSMesa) and the venv module; with the
# word "tests" what tests alone need: Chromium, its driver and Poppler, which open and print the report, and CalculiX,
# which makes bodies; with the word "windows" wine, which runs the program with CPython for Windows.
set -u
PATH=$PATH:/sbin:/usr/sbin
wanted=()
if [ "${1:-}" = tests ]; then
  without="the tests of the report in a browser and of bodies from CalculiX are skipped"
  [ -x /usr/bin/chromium ] || wanted+=(chromium)
  [ -x /usr/bin/chromedriver ] || wanted+=(chromium-driver)
  command -v pdftoppm >/dev/null || wanted+=(poppler-utils)
  command -v ccx >/dev/null || wanted+=(calculix-ccx)
elif [ "${1:-}" = windows ]; then
  without="without wine the program for Windows cannot be tried here"
  command -v wine >/dev/null || wanted+=(wine64 wine)
else
  without="without libosmesa6 there are no films"
  ldconfig -p 2>/dev/null | grep -q 'libOSMesa\.so' || wanted+=(libosmesa6)
  "${PYTHON:-python3}" -c 'import ensurepip, venv' 2>/dev/null || wanted+=(python3-venv)
fi
[ ${#wanted[@]} -eq 0 ] && exit 0
if [ "$(id -u)" -ne 0 ]; then
  echo "missing system packages: ${wanted[*]}; as root: apt-get install ${wanted[*]} ($without)"
  exit 0
fi
if ! command -v apt-get >/dev/null; then
  echo "missing: ${wanted[*]} (Debian names); install them with this system's package manager"
  exit 0
fi
echo "installing ${wanted[*]}"
export DEBIAN_FRONTEND=noninteractive
apt-get install -y -qq --no-install-recommends "${wanted[@]}" >/dev/null 2>&1 \
  || { apt-get update -qq >/dev/null 2>&1 && apt-get install -y -qq --no-install-recommends "${wanted[@]}" >/dev/null 2>&1; } \
  || echo "could not install ${wanted[*]}; the run goes on without what needs them"
exit 0
