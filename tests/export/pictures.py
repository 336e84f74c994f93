#!/usr/bin/python3
"""What PIL makes of a campaign's pictures, and of those in its exports.

    pictures.py CAMPAIGN            a line for each frame: index, ending, SHA-256 of the RGB values as PIL decodes them
    pictures.py CAMPAIGN EXPORTS    checks that every export holds the campaign's pictures under the right names

Exits with 1 and says what is wrong.
"""

import hashlib
import json
import pathlib
import sys
import tarfile

import PIL.Image

FORMATS = {".png": "PNG", ".jpg": "JPEG", ".webp": "WEBP", ".tif": "TIFF"}
# Whose images are the campaign's files, below images/, rgb/ or JPEGImages/.
PLACED = {"images": None, "rgb": None, "JPEGImages": ".jpg"}


def pictures(campaign):
    """Path of each frame's picture by its stem."""
    found = {}
    for manifest in sorted(campaign.glob("frames/*/*/manifest.json")):
        names = [name for name in json.loads(manifest.read_text())["files"] if name.startswith("image.")]
        (found[manifest.parent.name],) = (manifest.parent / name for name in names)
        others = {path.name for path in manifest.parent.glob("image.*")} - set(names)
        assert not others, f"{manifest.parent}: {others}"
    return found


def rgb_hash(path):
    image = PIL.Image.open(path)
    assert image.format == FORMATS[path.suffix], f"{path}: {image.format}"
    assert image.mode == "RGB", f"{path}: {image.mode}"
    return hashlib.sha256(image.tobytes()).hexdigest()


def check_placed(export, found):
    """Every picture once, the same bytes."""
    seen = []
    for path in export.rglob("*"):
        folders = [folder for folder in path.parts[:-1] if folder in PLACED]
        if not path.is_file() or not folders:
            continue
        source = found[path.stem]
        # detectron2 and panopticapi look for .jpg beside the masks; readers go by the bytes.
        ending = ".jpg" if export.name == "coco-panoptic" else PLACED[folders[-1]] or source.suffix
        assert path.suffix == ending, path
        assert path.read_bytes() == source.read_bytes(), path
        PIL.Image.open(path).load()
        seen.append(path.stem)
    assert sorted(seen) == sorted(found), f"{export}: {seen}"


def check_file_names(export):
    """What COCO's files name is there."""
    for document in [*export.glob("annotations/*.json"), *export.rglob("scene_gt_coco.json")]:
        images = json.loads(document.read_text())["images"]
        split = document.stem.rpartition("_")[2]
        for image in images:
            folder = document.parent if document.stem == "scene_gt_coco" else export / "images" / split
            assert (folder / image["file_name"]).is_file(), f"{document}: {image['file_name']}"


def check_shards(export, found):
    for shard in export.glob("*.tar"):
        with tarfile.open(shard) as archive:
            for name in archive.getnames():
                stem, _, ending = name.partition(".")
                if ending in ("json", "instances.png"):
                    continue
                assert "." + ending == found[stem].suffix, name
                assert archive.extractfile(name).read() == found.pop(stem).read_bytes(), name
    assert not found, f"{export}: without {sorted(found)}"


def main():
    campaign = pathlib.Path(sys.argv[1])
    found = pictures(campaign)
    if len(sys.argv) == 2:
        for stem, path in found.items():
            print(int(stem), path.suffix, rgb_hash(path))
        return
    checked = 0
    for export in sorted(pathlib.Path(sys.argv[2]).iterdir()):
        if export.name == "webdataset":
            check_shards(export, dict(found))
        elif export.name not in ("patches", "statistics"):
            check_placed(export, found)
            check_file_names(export)
        checked += 1
        print(export.name, "ok")
    assert checked


if __name__ == "__main__":
    main()
