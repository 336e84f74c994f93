#!/bin/sh
# The main job from a bare Debian 12: installs, builds, renders configs/parts.yaml, exports it, makes a page about
# it, and says where to look. Run again, it renders nothing that is there.
set -eu
cd "$(dirname "$0")/.."
scripts/setup.sh
seedframe=build/release/seedframe
campaign=${1:-results/parts}
blender=blender # Debian's
[ ! -e venv/blender ] || blender=$(readlink -f venv/blender)
echo "demo.sh: renders with ${SEEDFRAME_BLENDER:-$blender}"
typed=seedframe # what the user can type, if setup.sh could arrange it
[ "$(readlink -f "$(command -v seedframe)")" = "$(readlink -f "$seedframe")" ] || typed=$seedframe

if [ -f "$campaign/campaign.sqlite" ]; then
  $seedframe resume "$campaign"
else
  $seedframe submit configs/parts.yaml -o "$campaign"
fi
$seedframe export "$campaign" --format coco --format coco-polygon --format yolo-detect \
  --format yolo-segment --split train=0.8,val=0.2
$seedframe status "$campaign"
$seedframe show "$campaign" --sheet 4x4 --layers image,image+instances -o "$campaign.jpg"
$seedframe report "$campaign"
cat <<END

Look at
  $campaign.jpg                                eight frames, and below each its masks
  $campaign/report.html                            a page about all of it: open it in a browser
  $campaign/frames/000/000000/image.png            the first image; beside it its masks, labels and frame spec
  $campaign/exports/coco/annotations/              COCO, one file a split
  $campaign/exports/yolo-segment/data.yaml         YOLO, ready for a trainer
  $typed explain $campaign 0                   where each number of frame 0 comes from
END
