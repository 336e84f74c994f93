#!/bin/sh
# Contact sheets of the papers' scenes, into results/scenes: a few frames of each config, smaller and with fewer samples
# than the configs ask for. Takes about 10 minutes on two idle cores.
#
#   scripts/scene_sheets.sh [NAME…]    NAME: only these sheets, such as robocup_fig2 (SEEDFRAME: the program)
set -eu
cd "$(dirname "$0")/.."
seedframe=${SEEDFRAME:-build/release/seedframe}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p results/scenes
wanted=" $* "
is_wanted() { case $wanted in "  " | *" $1 "*) ;; *) return 1 ;; esac; }

# sheet NAME COLUMNS WIDTH CONFIG ARGUMENTS…: submits and puts all frames, of that width, into one picture.
sheet() {
  name=$1 columns=$2 width=$3 config=$4
  shift 4
  is_wanted "$name" || return 0
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
# What a classifier of paper 1 is given, a row for each class.
if is_wanted robocup_patches; then
  "$seedframe" submit configs/robocup_spl.yaml -o "$work/patches" --quiet $quarter --set render.samples=8 \
    --set scenes=12 --set frames_per_scene=1
  "$seedframe" export "$work/patches" --format patches -o "$work/exports" --min-side 8 --min-visible 0.3 \
    --windows field,line --windows-per-frame 2
  scripts/patch_sheet.py "$work/exports" results/scenes/robocup_patches.jpg
fi
# Paper 3: 8 attributes, five classes; the initial distributions above, the target ones below.
sheet tyol_initial 8 128 tyol_multi_8_initial --set scenes=16
sheet tyol_target 8 128 tyol_multi_8_target --set scenes=16
