#!/bin/sh
# Makes a virtual environment with Blender as the Python module bpy: venv/blender-4.5 and the like, for
# --blender python:venv/blender-4.5. Versions are pinned. Run again, it does only what is missing.
#
#   scripts/blender_wheels.sh 4.5    or 4.2, or 5.0, or 5.2 where there is a Python 3.13
set -eu
cd "$(dirname "$0")/.."

python=/usr/bin/python3 # Debian 12's is 3.11, which these wheels are made for
abi=3.11
numpy=1.26.4
case ${1:-} in
  4.2) module=4.2.23 ;;
  4.5) module=4.5.15 ;;
  5.0) module=5.0.1 ;;
  5.2)
    module=5.2.3 abi=3.13 numpy=2.1.3
    python=$(command -v python3.13) && "$python" -c "import venv" 2>/dev/null ||
      { echo "blender_wheels.sh: Blender 5.2 needs Python 3.13, and no python3.13 in PATH works" >&2; exit 4; }
    ;;
  *) echo "blender_wheels.sh: expected 4.2, 4.5, 5.0 or 5.2, got '${1:-}'" >&2; exit 2 ;;
esac
venv=venv/blender-$1

packages=$venv/lib/python$abi/site-packages
if [ -f "$packages/bpy-$module.dist-info/RECORD" ] && [ -f "$packages/numpy-$numpy.dist-info/RECORD" ]; then
  exit 0
fi
echo "blender_wheels.sh: installing the module bpy $module into $venv (1 GB)"
[ -x "$venv/bin/python" ] || $python -m venv "$venv"
# Workers need numpy; what the wheel asks for beside it is for add-ons, which workers do without.
if ! "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --only-binary :all: \
    "bpy==$module" "numpy==$numpy"; then
  echo "blender_wheels.sh: bpy $module could not be installed: is PyPI reached from here?" >&2
  exit 4
fi
