#!/usr/bin/env bash
# Makes assets/ again from scripts/make_assets*.py: the same Blender gives the same files.
# Usage: scripts/make_assets.sh [NAME...]     (SEEDFRAME: the program, BLENDER: the Blender to use)
set -euo pipefail
home=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
blender=${BLENDER:-blender}
seedframe=${SEEDFRAME:-}
for build in release dev; do
  [ -n "$seedframe" ] || [ ! -x "$home/build/$build/seedframe" ] || seedframe=$home/build/$build/seedframe
done
[ -n "$seedframe" ] || { echo "make_assets: build seedframe first, or set SEEDFRAME" >&2; exit 1; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# One thread: with more, OpenVDB's remeshing orders the vertices as the threads happen to finish.
"$blender" --background --factory-startup --threads 1 --python-exit-code 1 \
  --python "$home/scripts/make_assets.py" -- "$work" "$@"

# import_part NAME SMOOTH_ANGLE DESCRIPTION [CATEGORY]: without a category a part is its own.
import_part() {
  local name=$1 angle=$2 description=$3 category=${4-$1}
  [ -f "$work/$name.obj" ] || return 0
  "$seedframe" asset import "$work/$name.obj" --root "$home/assets" --scale 0.001 --force \
    --smooth-angle "$angle" --category "$category" --description "$description"
}

# The angles lie between the steps of the part's arcs and its sharpest chamfer (30 degrees on hexagons).
import_part hex_bolt 25 "Hexagon head bolt M12 x 50"
import_part hex_nut 25 "Hexagon nut M12"
import_part washer 25 "Plain washer for M12"
import_part bracket 25 "Steel angle bracket with gusset and slots"
import_part housing_cap 25 "Moulded housing cap with latches and vents"
import_part pump_cover 42 "Cast water pump cover with volute and outlet"
import_part gear 25 "Spur gear, module 2.5, 24 teeth, with hub and keyway"
import_part bearing 25 "Deep-groove ball bearing 6203"
import_part cube 30 "Cube of 50 mm with small chamfers" ""
import_part sphere 30 "Sphere of 50 mm" ""
import_part cylinder 25 "Cylinder of 50 mm" ""
import_part cone 25 "Cone of 50 mm" ""
import_part torus 30 "Torus of 50 mm" ""

import_part robot_standing 40 "Humanoid robot of 57 cm, standing, facing +x" robot
import_part robot_sitting 40 "Humanoid robot, sitting with its legs stretched out, facing +x" robot
import_part robot_lying 40 "Humanoid robot, lying on its back, head towards +x" robot
import_part spl_ball 30 "Soccer ball of 100 mm for small robots" ball
import_part spl_goal_post 40 "Post of a soccer goal, 0.9 m high" goal_post
import_part spl_goal 40 "Crossbar and net of a soccer goal of 1.5 x 0.8 m for small robots, opening towards +x" goal
import_part spl_field 30 "Carpet of 10.4 x 7.4 m for a soccer field of 9 x 6 m" field
import_part spl_lines 30 "Lines of a soccer field of 9 x 6 m, 5 cm wide" line

import_part mug 40 "Mug of 0.3 l, its handle towards +x"
import_part teapot 40 "Round teapot, its spout towards +x"
import_part spray_bottle 40 "Spray bottle with a label, its nozzle towards +x"
import_part toy_car 35 "Toy car of 15 cm, driving towards +x"
import_part carton 30 "Milk carton, its label towards +x"
