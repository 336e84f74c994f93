#!/bin/sh
# Makes a virtual environment with Blender as the Python module bpy: venv/blender-4.5 and the like, for
# --blender python:venv/blender-4.5. Versions are pinned. Run again, it does only what is missing.
#
#   scripts/blender_wheels.sh 4.5    or 4.2, or 5.0
set -eu
cd "$(dirname "$0")/.."

case ${1:-} in
  4.2) module=4.2.23 ;;
  4.5) module=4.5.15 ;;
  5.0) module=5.0.1 ;;
  *) echo "blender_wheels.sh: expected 4.2, 4.5 or 5.0, got '${1:-}'" >&2; exit 2 ;;
esac
venv=venv/blender-$1
python=/usr/bin/python3 # Debian 12's is 3.11, which these wheels are made for

packages=$venv/lib/python3.11/site-packages
if [ -f "$packages/bpy-$module.dist-info/RECORD" ] && [ -f "$packages/numpy-1.26.4.dist-info/RECORD" ]; then
  exit 0
fi
echo "blender_wheels.sh: installing the module bpy $module into $venv (1 GB)"
[ -x "$venv/bin/python" ] || $python -m venv "$venv"
# Workers need numpy; what the wheel asks for beside it is for add-ons, which workers do without.
if ! "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --only-binary :all: \
    "bpy==$module" numpy==1.26.4; then
  echo "blender_wheels.sh: bpy $module could not be installed: is PyPI reached from here?" >&2
  exit 4
fi
