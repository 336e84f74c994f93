"""BOP: poses, masks, counts and models, as bop_toolkit reads them.

Lengths are millimetres, the camera looks along +z with y down, and pixel centres are whole numbers.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import coco
import numpy as np
from common import Annotation, Dataset, image_readers, tight_box
from PIL import Image

PLY_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2",
    "ushort": "u2", "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip


def read_ply(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Vertices (n, 3) float64, triangles (m, 3) and, if there are any, the vertices' normals (n, 3)
    of a PLY file, text or little endian."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    lines = [line.split() for line in data[:end].decode("ascii").splitlines()]
    if lines[0] != ["ply"]:
        raise ValueError(f"{path.name}: no PLY file")
    encoding = next(line[1] for line in lines if line[0] == "format")
    counts = {line[1]: int(line[2]) for line in lines if line[0] == "element"}
    properties = [line for line in lines if line[0] == "property"]
    scalars = [line for line in properties if line[1] != "list"]
    (faces,) = [line for line in properties if line[1] == "list"]
    names = [line[2] for line in scalars]
    columns = [names.index(axis) for axis in "xyz"]
    has_normals = {"nx", "ny", "nz"} <= set(names)
    if encoding == "ascii":
        rows = [line.split() for line in data[end:].decode("ascii").splitlines()]
        table = np.array(rows[: counts["vertex"]], dtype=float)
        triangles = np.array(rows[counts["vertex"] :], dtype=int)
        normals = table[:, [names.index(f"n{axis}") for axis in "xyz"]] if has_normals else None
        return table[:, columns], triangles[:, 1:], normals
    if encoding != "binary_little_endian":
        raise ValueError(f"{path.name}: format {encoding}")
    vertex = np.dtype([(line[2], "<" + PLY_TYPES[line[1]]) for line in scalars])
    face = np.dtype([("n", "<" + PLY_TYPES[faces[2]]), ("v", "<" + PLY_TYPES[faces[3]], 3)])
    size = counts["vertex"] * vertex.itemsize
    if len(data) != end + size + counts["face"] * face.itemsize:
        raise ValueError(f"{path.name}: not as long as its header says")
    table = np.frombuffer(data, vertex, counts["vertex"], end)
    polygons = np.frombuffer(data, face, counts["face"], end + size)
    if (polygons["n"] != 3).any():
        raise ValueError(f"{path.name}: faces that are no triangles")
    vertices = np.stack([table[axis] for axis in "xyz"], axis=1).astype(np.float64)
    normals = np.stack([table[f"n{axis}"] for axis in "xyz"], axis=1) if has_normals else None
    return vertices, polygons["v"].astype(np.int64), normals


def project(points: np.ndarray, rotation: list, translation: list, matrix: list) -> np.ndarray:
    """Pixels (n, 2) of a model's points (n, 3), nan for those that are not in front."""
    camera = points @ np.reshape(rotation, (3, 3)).T + np.array(translation)
    pixels = camera @ np.reshape(matrix, (3, 3)).T
    depth = np.where(pixels[:, 2:] > 0, pixels[:, 2:], np.nan)
    return pixels[:, :2] / depth


def _read_mask(path: Path) -> np.ndarray:
    image = Image.open(path)
    values = np.array(image)
    if image.mode != "L" or not np.isin(values, (0, 255)).all():
        raise ValueError(f"{path.parent.name}/{path.name}: not an 8-bit image of 0 and 255")
    return values == 255


def _boxes_of_coco(scene: Path, dataset: Dataset, split: str) -> dict[str, list[Annotation]]:
    """Annotations of scene_gt_coco.json by stem."""
    document = json.loads((scene / "scene_gt_coco.json").read_text())
    images = {image["id"]: image for image in document["images"]}
    names = {category["id"]: category["name"] for category in document["categories"]}
    if any(int(Path(image["file_name"]).stem) != id for id, image in images.items()):
        dataset.problems.append(f"{split}/{scene.name}: image ids are not the frames' indices")
    if [a for a in images.values() if a["file_name"] != f"rgb/{Path(a['file_name']).name}"]:
        dataset.problems.append(f"{split}/{scene.name}: file names are not in rgb/")
    found: dict[str, list[Annotation]] = {Path(i["file_name"]).stem: [] for i in images.values()}
    for entry in document["annotations"]:
        name = names[entry["category_id"]]
        annotation = coco.annotation_of(entry, images[entry["image_id"]], name, split)
        annotation.extras["bbox"] = entry["bbox"]
        found[annotation.stem].append(annotation)
    return found


def _read_scene(scene: Path, dataset: Dataset, split: str) -> None:
    """Adds a scene's images and instances to the dataset."""
    camera, poses, info = (
        json.loads((scene / f"scene_{name}.json").read_text())
        for name in ("camera", "gt", "gt_info")
    )
    boxes = _boxes_of_coco(scene, dataset, split)
    images = image_readers(scene / "rgb")
    dataset.images.update(images)
    if not camera.keys() == poses.keys() == info.keys() == {str(int(stem)) for stem in boxes}:
        dataset.problems.append(f"{split}/{scene.name}: the JSON files hold other images")
    numbers = [f"{int(key):06}_{n:06}" for key in poses for n in range(len(poses[key]))]
    for name in ("mask", "mask_visib"):
        if sorted(path.stem for path in (scene / name).glob("*")) != sorted(numbers):
            dataset.problems.append(f"{split}/{scene.name}/{name}: not one file for each instance")
    for key in sorted(poses, key=int):
        stem = f"{int(key):06}"
        dataset.splits[split].append(stem)
        dataset.scenes[stem] = int(scene.name)
        depth_file = scene / "depth" / f"{stem}.png"
        depth = np.array(Image.open(depth_file)) if depth_file.is_file() else None
        dataset.extras["images"][stem] = {"camera": camera[key], "depth": depth}
        if not len(poses[key]) == len(info[key]) == len(boxes[stem]):
            raise ValueError(f"{split}/{scene.name}: the JSON files hold other instances of {key}")
        for number, (pose, counts) in enumerate(zip(poses[key], info[key], strict=True)):
            annotation = boxes[stem][number]
            extras = {"coco": annotation.extras, "coco_mask": annotation.mask, **pose, **counts}
            box = tight_box(annotation.mask)
            extras["mask"] = _read_mask(scene / "mask" / f"{stem}_{number:06}.png")
            extras["asset"] = dataset.extras["models"][pose["obj_id"]]["asset"]
            visible = _read_mask(scene / "mask_visib" / f"{stem}_{number:06}.png")
            dataset.annotations.append(
                Annotation(stem, split, annotation.name, visible, box, extras)
            )


def load(folder: Path) -> Dataset:
    """Everything in `OUT/bop`. Masks and boxes are the visible ones; names are those of
    scene_gt_coco.json; extras: the instance's entries in all files, and the full mask."""
    folder = Path(folder)
    models = {int(k): v for k, v in json.loads((folder / "models.json").read_text()).items()}
    info = json.loads((folder / "models/models_info.json").read_text())
    dataset = Dataset([models[i]["asset"] for i in sorted(models)], {}, [])
    dataset.extras = {"images": {}, "models": models, "targets": {}, "meshes": {}}
    dataset.extras["camera"] = json.loads((folder / "camera.json").read_text())
    dataset.extras["models_info"] = {int(key): value for key, value in info.items()}
    for path in sorted((folder / "models").glob("obj_*.ply")):
        dataset.extras["meshes"][int(path.stem.removeprefix("obj_"))] = read_ply(path)
    for path in sorted(folder.glob("*_targets_bop19.json")):
        split = path.name.removesuffix("_targets_bop19.json")
        dataset.extras["targets"][split] = json.loads(path.read_text())
        dataset.splits[split] = []
        for scene in sorted((folder / split).glob("[0-9]*")):
            _read_scene(scene, dataset, split)
    return dataset


def read(folder: Path) -> Iterator[Annotation]:
    """The annotations of all splits."""
    yield from load(folder).annotations
