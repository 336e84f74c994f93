#!/bin/sh
# Makes venv/blenderproc, a virtual environment with BlenderProc, which scripts/bench.sh throughput compares Seedframe
# with. Versions are pinned; Blender is the module bpy of venv/blender-4.2, so that both sides render with the same.
# Run again, it does only what is missing.
set -eu
cd "$(dirname "$0")/.."

scripts/blender_wheels.sh 4.2
venv=venv/blenderproc
packages=$venv/lib/python3.11/site-packages
[ ! -d "$packages/blenderproc-2.8.0.dist-info" ] || exit 0
echo "blenderproc_wheels.sh: installing BlenderProc 2.8.0 into $venv"
[ -x "$venv/bin/python" ] || /usr/bin/python3 -m venv "$venv"
echo "../../../../blender-4.2/lib/python3.11/site-packages" >"$packages/blender.pth"
# What its page on the module bpy asks for, but for what neither rendering nor COCO needs (pyrender, PyQt5). Itself last:
# that it is there shows that all is.
if ! "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --only-binary :all: \
    pyyaml==6.0.1 requests==2.32.3 imageio==2.34.1 gitpython==3.1.43 scikit-image==0.23.2 pypng==0.20220715.0 \
    scipy==1.13.1 matplotlib==3.9.0 pytz==2024.1 h5py==3.11.0 Pillow==10.3.0 \
    opencv-contrib-python-headless==4.10.0.84 scikit-learn==1.5.0 python-dateutil==2.9.0.post0 rich==13.7.1 \
    trimesh==4.4.0 numpy==1.26.4 ||
  ! "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps blenderproc==2.8.0; then
  echo "blenderproc_wheels.sh: BlenderProc could not be installed: is PyPI reached from here?" >&2
  exit 4
fi
