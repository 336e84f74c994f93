#!/bin/sh
# Audits the demo campaign over every condition, in the mode that promises the same pixels under all of them.
#
#   tests/bench/audit_demo.sh REPORT [FRAMES]
set -eu
report=$1
frames=${2:-30}
home=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$home/build/release/seedframe" submit "$home/configs/parts.yaml" -o "$folder/parts" --set determinism=portable --quiet
"$home/build/release/seedframe" export "$folder/parts" --format coco --format yolo-segment
code=0
"$home/build/release/seedframe" audit "$folder/parts" --vary all --frames "$frames" --quiet || code=$?
cp "$folder/parts/audit/report.md" "$report"
exit $code
