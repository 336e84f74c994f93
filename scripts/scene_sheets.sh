#!/bin/sh
# Contact sheets of the papers' scenes, into results/scenes: a few frames of each config, smaller and with fewer samples
# than the configs ask for. Takes about 10 minutes on two idle cores.
#
#   scripts/scene_sheets.sh [NAME…]    NAME: only these sheets, such as robocup_fig2
set -eu
cd "$(dirname "$0")/.."
seedframe=build/release/seedframe
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p results/scenes
wanted=" $* "

# sheet NAME COLUMNS WIDTH CONFIG ARGUMENTS…: submits and puts all frames, of that width, into one picture.
sheet() {
  name=$1 columns=$2 width=$3 config=$4
  shift 4
  case $wanted in "  " | *" $name "*) ;; *) return ;; esac
  "$seedframe" submit "configs/$config.yaml" -o "$work/$name" --quiet "$@"
  "$seedframe" show "$work/$name" all --sheet "$columns" --tile-width "$width" --layers image --plain \
    -o "results/scenes/$name.jpg" --overwrite
}

# masks NAME COLUMNS WIDTH FRAMES: the classes in these frames of a campaign that sheet() has made.
masks() {
  [ -d "$work/$1" ] || return 0
  "$seedframe" show "$work/$1" "$4" --sheet "$2" --tile-width "$3" --layers semantic \
    -o "results/scenes/$1_masks.jpg" --overwrite
}
quarter="--set render.width=320 --set render.height=240"

# Figure 2 of paper 1: a row for each tint; in it for each intensity three field colours. And the masks of its third row.
sheet robocup_fig2 6 320 robocup_fig2 $quarter --set render.samples=48
masks robocup_fig2 6 320 12-17
sheet robocup_spl 4 320 robocup_spl $quarter --set render.samples=64 --set scenes=6 --set frames_per_scene=2
sheet robocup_hall 3 320 robocup_hall $quarter --set render.samples=64 --set scenes=3 --set frames_per_scene=2
sheet parts_study 3 320 parts_study $quarter --set render.samples=48 --set scenes=3 --set frames_per_scene=2
# Paper 3: 8 attributes, five classes; the initial distributions above, the target ones below.
sheet tyol_initial 8 128 tyol_multi_8_initial --set scenes=16
sheet tyol_target 8 128 tyol_multi_8_target --set scenes=16
