"""What is known of the instances of a frame (docs/formats/labels.md), as typed values.

Pixels: x to the right, y down; pixel (row r, column c) covers [c, c + 1) × [r, r + 1). Lengths are metres. The camera's frame
is x right, y up, z towards the viewer, unless a name says OpenCV's.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import Error

VERSION = 3

Box = tuple[int, int, int, int]


@dataclass(frozen=True)
class Camera:
    """The pinhole of a frame."""

    focal_px: tuple[float, float]
    center_px: tuple[float, float]  #: principal point; pixel centres are whole numbers

    @property
    def matrix(self) -> npt.NDArray[np.float64]:
        """OpenCV's K, 3 × 3, in pixels."""
        return np.array([[self.focal_px[0], 0, self.center_px[0]], [0, self.focal_px[1], self.center_px[1]], [0, 0, 1]])


@dataclass(frozen=True)
class Pose:
    """Where an instance is: point in the camera's frame = rotation · (scale × point of the mesh) + translation_m."""

    rotation: npt.NDArray[np.float64]  #: 3 × 3
    scale: npt.NDArray[np.float64]  #: 3
    translation_m: npt.NDArray[np.float64]  #: 3

    @property
    def matrix(self) -> npt.NDArray[np.float64]:
        """4 × 4, from the mesh to the camera's frame (x right, y up, z towards the viewer), with its scale."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.rotation * self.scale
        matrix[:3, 3] = self.translation_m
        return matrix

    @property
    def matrix_opencv(self) -> npt.NDArray[np.float64]:
        """4 × 4, from the mesh to OpenCV's camera (x right, y down, z ahead), with its scale."""
        return np.diag([1.0, -1.0, -1.0, 1.0]) @ self.matrix


@dataclass(frozen=True)
class Keypoint:
    """A named point of an asset."""

    name: str
    px: tuple[float, float]  #: x, y, 0 being the edge of the first pixel
    visibility: int  #: 2 visible; 1 something stands before it; 0 outside the image, and px is (0, 0)


@dataclass(frozen=True)
class Amodal:
    """An instance as if nothing stood before it and the image had no edge."""

    area_px: int
    in_image_px: int
    box: Box  #: x, y, width, height; x and y may be negative
    complete: bool  #: False: it may go on beyond the canvas, which is the image and as much on each side
    pose: Pose
    object_box_m: npt.NDArray[np.float64]  #: 2 × 3: least and greatest corner, in the mesh's coordinates
    box_corners_px: npt.NDArray[np.float64]  #: 8 × 2; NaN for a corner that is not in front of the camera
    rle: str  #: run lengths as COCO packs them, of a mask of the size of `box`

    def silhouette(self) -> npt.NDArray[np.bool_]:
        """Its mask in `box`: bool, box height × box width."""
        return decode_rle(self.rle, self.box[3], self.box[2])


@dataclass(frozen=True)
class Instance:
    """One object in a frame."""

    id: int  #: its value in ids
    category: int  #: from 1; 0: a distractor
    category_name: str  #: empty for a distractor
    name: str  #: object/copy
    asset: str
    area_px: int  #: of visible pixels; 0: hidden or out of view
    box: Box  #: x, y, width, height of the visible pixels; all 0 if there is none
    visible_fraction: float  #: of its silhouette, 0 to 1
    truncation: float  #: share of its silhouette that is outside the image
    keypoints: tuple[Keypoint, ...]
    amodal: Amodal

    @property
    def box_xyxy(self) -> tuple[int, int, int, int]:
        """Left, top, right, bottom, the last two beyond the last pixel."""
        x, y, width, height = self.box
        return x, y, x + width, y + height


@dataclass(frozen=True)
class Labels:
    """What labels.json says of a frame."""

    raw: Mapping[str, Any]  #: as it was read

    def __post_init__(self) -> None:
        version = self.raw.get("version") if isinstance(self.raw, Mapping) else None
        if version != VERSION:
            raise Error(
                f"labels of version {version}; this package reads version {VERSION}: install the one that belongs to the "
                "program",
                "corrupt",
            )

    @property
    def width(self) -> int:
        """Of the image, pixels."""
        return int(self.raw["width"])

    @property
    def height(self) -> int:
        """Of the image, pixels."""
        return int(self.raw["height"])

    @property
    def categories(self) -> list[str]:
        """Names; category 1 is the first."""
        return list(self.raw["categories"])

    @property
    def twin_exact(self) -> bool:
        """False: textures cut holes into something, and what is amodal knows nothing of them."""
        return bool(self.raw["twin_exact"])

    @property
    def target(self) -> int | None:
        """Id of the instance that a patch is a picture of."""
        return self.raw.get("target")

    @cached_property
    def camera(self) -> Camera:
        """The pinhole."""
        camera = self.raw["camera"]
        return Camera(tuple(camera["focal_px"]), tuple(camera["center_px"]))

    @cached_property
    def instances(self) -> tuple[Instance, ...]:
        """All that have an id, also those that cannot be seen and distractors."""
        names = ["", *self.categories]
        return tuple(_instance(each, names) for each in self.raw["instances"])

    @property
    def visible(self) -> tuple[Instance, ...]:
        """Instances of a category of which at least one pixel is seen: what detectors are trained on."""
        return tuple(each for each in self.instances if each.category > 0 and each.area_px > 0)

    def instance(self, wanted: int) -> Instance:
        """The instance with this id.

        Raises:
            Error: (``input``) there is none.

        """
        for each in self.instances:
            if each.id == wanted:
                return each
        raise Error(f"no instance has id {wanted}; there are {', '.join(str(each.id) for each in self.instances)}")

    @property
    def boxes(self) -> npt.NDArray[np.int64]:
        """Of `visible`: N × 4, left, top, right, bottom."""
        return np.array([each.box_xyxy for each in self.visible], np.int64).reshape(-1, 4)

    @property
    def category_ids(self) -> npt.NDArray[np.int64]:
        """Of `visible`: N, from 1."""
        return np.array([each.category for each in self.visible], np.int64)


def _instance(raw: Mapping[str, Any], names: list[str]) -> Instance:
    amodal = raw["amodal"]
    pose = amodal["pose"]
    return Instance(
        id=raw["id"],
        category=raw["category"],
        category_name=names[raw["category"]],
        name=raw["name"],
        asset=raw["asset"],
        area_px=raw["area_px"],
        box=tuple(raw["box"]),
        visible_fraction=float(raw["visible_fraction"]),
        truncation=float(raw["truncation"]),
        keypoints=tuple(Keypoint(k["name"], tuple(k["px"]), k["visibility"]) for k in raw.get("keypoints", ())),
        amodal=Amodal(
            area_px=amodal["area_px"],
            in_image_px=amodal["in_image_px"],
            box=tuple(amodal["box"]),
            complete=amodal["complete"],
            pose=Pose(
                np.array(pose["rotation"], np.float64).reshape(3, 3),
                np.array(pose["scale"], np.float64),
                np.array(pose["translation_m"], np.float64),
            ),
            object_box_m=np.array(amodal["object_box_m"], np.float64),
            box_corners_px=np.array([c or (np.nan, np.nan) for c in amodal["box_corners_px"]], np.float64),
            rle=amodal["rle"],
        ),
    )


def decode_rle(text: str, height: int, width: int) -> npt.NDArray[np.bool_]:
    """A mask from COCO's compressed run lengths: bool, height × width.

    Raises:
        Error: (``corrupt``) the runs are not of a mask of this size.

    """
    runs: list[int] = []
    value = shift = 0
    for letter in text.encode():
        bits = letter - 48
        value |= (bits & 0x1F) << shift
        shift += 5
        if bits & 0x20:
            continue
        if bits & 0x10:
            value -= 1 << shift
        # From the third run on, the difference to the run before the last.
        runs.append(value + (runs[-2] if len(runs) > 2 else 0))
        value = shift = 0
    if shift or sum(runs) != height * width or any(run < 0 for run in runs):
        raise Error(
            f"the run lengths of a mask of {width} × {height} pixels are damaged; render the frame again", "corrupt"
        )
    colors = np.arange(len(runs)) % 2 == 1
    return np.repeat(colors, runs).reshape(width, height).T  # columns first
