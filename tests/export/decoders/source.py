"""The truth: a campaign's finished frames, from labels.json (version 3) and instances.png."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import rle
from common import PICTURES, tight_box
from PIL import Image

LABELS_VERSION = 3


@dataclass
class Keypoint:
    """x, y in pixels, continuous: 0 is the left or upper edge of the first pixel."""

    name: str
    x: float
    y: float
    visibility: int  # 0 not in view, 1 hidden, 2 visible


@dataclass
class Instance:
    """An instance that exports hold. Masks are (height, width) bool."""

    id: int
    category: int  # 1-based
    name: str  # class
    asset: str
    visible: np.ndarray
    silhouette: np.ndarray  # what lies in the image of it
    mask: np.ndarray  # the one of both that formats show
    box: tuple[int, int, int, int]  # of `mask`
    visible_box: tuple[int, int, int, int]
    area: int  # visible pixels
    amodal_area: int  # on the enlarged canvas
    amodal_box: tuple[int, int, int, int]  # may leave the image
    in_image: int
    visible_fraction: float
    truncation: float
    complete: bool
    keypoints: list[Keypoint] | None  # None: the asset has none
    rotation: np.ndarray  # (3, 3), camera with y up and z backwards
    translation: np.ndarray  # (3,), metres
    object_box: np.ndarray  # (2, 3), metres: least and greatest corner
    corners: list[tuple[float, float] | None]  # 8, continuous pixels


@dataclass
class Frame:
    """A finished frame."""

    index: int
    stem: str
    frame_id: str
    width: int
    height: int
    focal: tuple[float, float]  # pixels
    centre: tuple[float, float]  # pixels, pixel centres at whole numbers
    instances: list[Instance]
    image: Path | None
    has_depth: bool
    twin_exact: bool
    unlabelled: np.ndarray  # (height, width) bool: pixels of nothing that has a category


@dataclass
class Campaign:
    """All finished frames, by stem, and the classes in their order."""

    categories: list[str]
    frames: dict[str, Frame]

    @property
    def has_images(self) -> bool:
        return any(frame.image for frame in self.frames.values())


def _silhouette(amodal: dict, height: int, width: int) -> np.ndarray:
    """The part of the amodal mask that lies in the image."""
    x, y, box_width, box_height = amodal["box"]
    mask = np.zeros((height, width), dtype=bool)
    if box_width == 0 or box_height == 0:
        return mask
    whole = rle.mask_of_runs(rle.runs_of_text(amodal["rle"]), box_height, box_width)
    left, top = max(x, 0), max(y, 0)
    right, bottom = min(x + box_width, width), min(y + box_height, height)
    if left < right and top < bottom:
        mask[top:bottom, left:right] = whole[top - y : bottom - y, left - x : right - x]
    return mask


def _instance(entry: dict, ids: np.ndarray, categories: list[str], amodal: bool) -> Instance:
    visible = ids == entry["id"]
    whole = entry["amodal"]
    silhouette = _silhouette(whole, *ids.shape)
    mask = silhouette if amodal else visible
    if tight_box(visible) != tuple(entry["box"]) or visible.sum() != entry["area_px"]:
        raise ValueError(f"instance {entry['id']}: labels.json and instances.png differ")
    if silhouette.sum() != whole["in_image_px"] or (visible & ~silhouette).any():
        raise ValueError(f"instance {entry['id']}: silhouette and labels.json differ")
    keypoints = entry.get("keypoints")
    return Instance(
        id=entry["id"],
        category=entry["category"],
        name=categories[entry["category"] - 1],
        asset=entry["asset"],
        visible=visible,
        silhouette=silhouette,
        mask=mask,
        box=tight_box(mask),
        visible_box=tuple(entry["box"]),
        area=entry["area_px"],
        amodal_area=whole["area_px"],
        amodal_box=tuple(whole["box"]),
        in_image=whole["in_image_px"],
        visible_fraction=entry["visible_fraction"],
        truncation=entry["truncation"],
        complete=whole["complete"],
        keypoints=None
        if keypoints is None
        else [Keypoint(k["name"], *k["px"], k["visibility"]) for k in keypoints],
        rotation=np.reshape(whole["pose"]["rotation"], (3, 3)),
        translation=np.array(whole["pose"]["translation_m"]),
        object_box=np.array(whole["object_box_m"]),
        corners=[None if c is None else tuple(c) for c in whole["box_corners_px"]],
    )


def _picture(folder: Path, size: tuple[int, int]) -> Path | None:
    """The frame's picture: RGB, of the size, in the format that its ending and manifest say."""
    manifest = json.loads((folder / "manifest.json").read_text())
    names = [name for name in manifest["files"] if name.startswith("image.")]
    if not names:
        return None
    (name,) = names
    path = folder / name
    picture = Image.open(path)
    said = manifest.get("image", {"format": "png"})["format"].upper()
    if not picture.format == PICTURES[path.suffix] == said:
        raise ValueError(f"{path}: a {picture.format}, and the manifest says {said}")
    if picture.mode != "RGB" or picture.size != size:
        raise ValueError(f"{path}: {picture.mode}, {picture.size}, not RGB of {size}")
    picture.load()
    return path


def read_frame(folder: Path, min_pixels: int, min_visible: float, amodal: bool) -> Frame:
    """One frame's folder, with the instances that pass the filters."""
    labels = json.loads((folder / "labels.json").read_text())
    if labels["version"] != LABELS_VERSION:
        raise ValueError(f"{folder}: labels of version {labels['version']}")
    ids = np.array(Image.open(folder / "instances.png"))
    if ids.shape != (labels["height"], labels["width"]):
        raise ValueError(f"{folder}: instances.png has another size than labels.json says")
    exported = [
        entry
        for entry in labels["instances"]
        if entry["category"] > 0
        and entry["area_px"] >= min_pixels
        and entry["visible_fraction"] >= min_visible
    ]
    labelled = [entry["id"] for entry in labels["instances"] if entry["category"] > 0]
    image = _picture(folder, (labels["width"], labels["height"]))
    return Frame(
        index=int(folder.name),
        stem=folder.name,
        frame_id=json.loads((folder / "manifest.json").read_text())["frame_id"],
        width=labels["width"],
        height=labels["height"],
        focal=tuple(labels["camera"]["focal_px"]),
        centre=tuple(labels["camera"]["center_px"]),
        instances=[_instance(e, ids, labels["categories"], amodal) for e in exported],
        image=image,
        has_depth=(folder / "depth.exr").is_file(),
        twin_exact=labels["twin_exact"],
        unlabelled=~np.isin(ids, labelled),
    )


def read(
    folder: Path, min_pixels: int = 1, min_visible: float = 0.0, amodal: bool = False
) -> Campaign:
    """The frames that are finished, which are those with a manifest."""
    frames: dict[str, Frame] = {}
    categories: list[str] | None = None
    for manifest in sorted(Path(folder).glob("frames/[0-9]*/[0-9]*/manifest.json")):
        frame_folder = manifest.parent
        if frame_folder.parent.name != f"{int(frame_folder.name) // 1000:03}":
            raise ValueError(f"{frame_folder}: in the wrong folder of thousands")
        names = json.loads((frame_folder / "labels.json").read_text()).get("categories")
        categories = names if categories is None else categories
        frames[frame_folder.name] = read_frame(frame_folder, min_pixels, min_visible, amodal)
        if names != categories:
            raise ValueError(f"{frame_folder}: other categories than the frames before")
    if not frames:
        raise ValueError(f"{folder}: no finished frames")
    return Campaign(categories or [], frames)
