#!/bin/sh
# Contact sheets of the papers' scenes, into results/scenes: a few frames of each config, smaller and with fewer samples
# than the configs ask for, most of them denoised (which Debian's Blender cannot). Takes about 5 minutes on two idle cores.
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
draft="$quarter --set render.samples=6 --set render.denoise=oidn_fast"

# patches NAME CAMPAIGN…: what a classifier is given, a row for each class, of campaigns that sheet() has made.
patches() {
  name=$1
  shift
  exports=
  for campaign in "$@"; do
    [ -d "$work/$campaign" ] || return 0
    "$seedframe" export "$work/$campaign" --format patches -o "$work/$campaign.exports" --min-side 8 --min-visible 0.3 \
      --windows field,line --windows-per-frame 2
    exports="$exports $work/$campaign.exports"
  done
  # shellcheck disable=SC2086  # no name has a blank
  scripts/patch_sheet.py "results/scenes/$name.jpg" $exports
}

# Figure 2 of paper 1: a row for each tint; in it for each intensity three field colours. And the masks of its third row.
sheet robocup_fig2 6 320 robocup_fig2 $quarter --set render.samples=48
masks robocup_fig2 6 320 12-17
sheet robocup_spl 4 320 robocup_spl $draft --set scenes=6 --set frames_per_scene=2
sheet robocup_hall 3 320 robocup_hall $draft --set scenes=3 --set frames_per_scene=2
# The upper camera sees more of robots and goals.
patches robocup_patches robocup_spl robocup_hall
sheet parts_study 3 320 parts_study $draft --set scenes=3 --set frames_per_scene=2
# Paper 3: 8 attributes, five classes; the initial distributions above, the target ones below.
sheet tyol_initial 8 128 tyol_multi_8_initial --set scenes=16
sheet tyol_target 8 128 tyol_multi_8_target --set scenes=16
