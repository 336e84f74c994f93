"""Campaigns on the disk: their frames, read as they are asked for."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import Any, Callable, overload

import numpy as np
import numpy.typing as npt

from .errors import Error
from .exr import decode_exr
from .labels import Labels
from .png import decode_png
from .program import StrPath, run_json
from .views import FrameViews

_PICTURES = ("image.png", "image.jpg", "image.webp", "image.tif")


class Frame(FrameViews):
    """One frame of a campaign. Everything is read when it is first asked for, and kept as long as the frame is.

    Each property raises Error: ``input`` if the campaign has no such thing, ``corrupt`` if a file is damaged.
    """

    def __init__(self, folder: Path, number: int) -> None:
        self.folder = folder  #: with its files (docs/formats/campaign.md)
        self.number = number  #: in the campaign, from 0

    def __repr__(self) -> str:
        return f"Frame({self.number}, {str(self.folder)!r})"

    @property
    def is_made(self) -> bool:
        """Whether its files are there: a frame's folder appears when it is complete."""
        return (self.folder / "manifest.json").is_file()

    @cached_property
    def labels(self) -> Labels:
        """What is known of its instances (labels.json)."""
        return Labels(self._json("labels.json"))

    @cached_property
    def spec(self) -> dict[str, Any]:
        """The frame as numbers (frame.json, docs/formats/frame-spec.md): camera, lights, materials, every transform."""
        return self._json("frame.json")

    @cached_property
    def manifest(self) -> dict[str, Any]:
        """Sizes and hashes (manifest.json): ``files``, ``pixels`` and ``frame_id``."""
        return self._json("manifest.json")

    @property
    def frame_id(self) -> str:
        """SHA-256 of what was to be rendered, hexadecimal."""
        return str(self.manifest["frame_id"])

    @property
    def image_path(self) -> Path:
        """The file of the picture."""
        for name in _PICTURES:
            path = self.folder / name
            if path.is_file():
                return path
        raise self._missing("a picture (image.png, .jpg, .webp or .tif)", "labels: geometry makes none")

    @cached_property
    def image(self) -> npt.NDArray[np.uint8]:
        """The picture: uint8, rows × columns × 3, sRGB. All but PNG need Pillow."""
        path = self.image_path
        if path.suffix != ".png":
            return _by_pillow(path)
        return _expect(decode_png(_read(path), str(path)), path, np.uint8, 3)

    @cached_property
    def ids(self) -> npt.NDArray[np.uint16]:
        """Which instance each pixel belongs to (instances.png): uint16, rows × columns, 0 is background."""
        path = self._path("instances.png", "it is of every frame")
        return _expect(decode_png(_read(path), str(path)), path, np.uint16, 2)

    @cached_property
    def semantic(self) -> npt.NDArray[np.uint8]:
        """The category of each pixel (semantic.png): uint8, rows × columns, from 1; 0 is background and distractors."""
        path = self._path("semantic.png", "it is of every frame")
        return _expect(decode_png(_read(path), str(path)), path, np.uint8, 2)

    @cached_property
    def depth(self) -> npt.NDArray[np.float32]:
        """Metres along the viewing axis (depth.exr): float32, rows × columns; 1e10 is background."""
        path = self._path("depth.exr", "render.passes: [depth] in the config makes it")
        return _channels(path, "Z")[0]

    @cached_property
    def normal(self) -> npt.NDArray[np.float32]:
        """Unit normals in the camera's frame, x right, y up, z towards the viewer (normal.exr): float32, rows × columns × 3;
        0 is background.
        """
        path = self._path("normal.exr", "render.passes: [normal] in the config makes it")
        return np.stack(_channels(path, "XYZ"), axis=-1)

    def _path(self, name: str, why_not: str) -> Path:
        path = self.folder / name
        if path.is_file():
            return path
        raise self._missing(name, why_not)

    def _missing(self, name: str, why_not: str) -> Error:
        if not self.is_made:
            return Error(
                f"frame {self.number} is not made: there is no {self.folder}. 'seedframe status' says which frames are "
                "missing, 'seedframe resume' makes them"
            )
        return Error(f"frame {self.number} has no {name} in {self.folder}: {why_not}")

    def _json(self, name: str) -> dict[str, Any]:
        path = self._path(name, "it is of every frame")
        try:
            content = json.loads(_read(path))
        except ValueError as why:
            raise Error(
                f"{path} is damaged ({why}): 'seedframe resume --verify' makes the frame again", "corrupt"
            ) from why
        if not isinstance(content, dict):
            raise Error(
                f"{path} is damaged: expected an object; 'seedframe resume --verify' makes the frame again", "corrupt"
            )
        return content


class Campaign:
    """A campaign's folder: what it has, and its frames by number.

    Opening reads nothing but the counts of ``seedframe status``. Iterating gives the frames that are made, in order; nothing
    is listed, and nothing of a frame is read that is not asked for.

    Args:
        path: the folder that ``seedframe submit`` made.

    Raises:
        Error: it is no campaign.

    """

    def __init__(self, path: StrPath) -> None:
        self.path = Path(path)
        status = self.status()
        self.total = int(status["frames"])  #: frames of the campaign, made or not
        self._all_made = int(status["done"]) == self.total

    def __repr__(self) -> str:
        return f"Campaign({str(self.path)!r})"

    def status(self) -> dict[str, Any]:
        """What ``seedframe status --json`` says now: ``frames``, ``done``, ``failed``, ``left_s``, ``dataset_hash``, …"""
        status: dict[str, Any] = run_json(["status", str(self.path), "--json"])
        return status

    @cached_property
    def inputs(self) -> dict[str, Any]:
        """What the campaign keeps of its config: ``name``, ``seed``, ``categories``, … (inputs/inputs.json)."""
        path = self.path / "inputs" / "inputs.json"
        try:
            content: dict[str, Any] = json.loads(_read(path))
        except ValueError as why:
            raise Error(f"{path} is damaged ({why}): 'seedframe resume' writes it again", "corrupt") from why
        return content

    @property
    def categories(self) -> list[str]:
        """Names; category 1 is the first."""
        return list(self.inputs["categories"])

    @cached_property
    def numbers(self) -> range | list[int]:
        """Of the frames that were made when this was first asked for, ascending."""
        if self._all_made:
            return range(self.total)
        return [number for number in range(self.total) if self.frame(number).is_made]

    def frame(self, number: int) -> Frame:
        """A frame, made or not. Nothing is looked at."""
        return Frame(self.path / "frames" / f"{number // 1000:03d}" / f"{number:06d}", number)

    def __len__(self) -> int:
        """How many frames are made."""
        return len(self.numbers)

    def __iter__(self) -> Iterator[Frame]:
        return (self.frame(number) for number in self.numbers)

    def __contains__(self, number: object) -> bool:
        if not isinstance(number, int) or not 0 <= number < self.total:
            return False
        return self._all_made or self.frame(number).is_made

    @overload
    def __getitem__(self, number: int) -> Frame: ...
    @overload
    def __getitem__(self, number: slice) -> list[Frame]: ...
    def __getitem__(self, number: int | slice) -> Frame | list[Frame]:
        """The frame with this number, from the end if it is negative; of a slice, those that are made.

        Raises:
            IndexError: the campaign has no such frame, or it is not made.

        """
        if isinstance(number, slice):
            wanted = range(self.total)[number]
            return [self.frame(each) for each in wanted if each in self]
        found = number + self.total if number < 0 else number
        if not 0 <= found < self.total:
            raise IndexError(f"{self.path} has frames 0 to {self.total - 1}, not {number}")
        frame = self.frame(found)
        if not self._all_made and not frame.is_made:
            raise IndexError(
                f"frame {found} of {self.path} is not made: 'seedframe resume {self.path}' makes what is missing"
            )
        return frame


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except FileNotFoundError as why:
        raise Error(f"{path} is not there") from why
    except OSError as why:
        raise Error(f"{path} cannot be read: {why.strerror}", "environment") from why


def _expect(pixels: npt.NDArray[Any], path: Path, kind: Any, dimensions: int) -> npt.NDArray[Any]:
    if pixels.dtype == kind and pixels.ndim == dimensions:
        return pixels
    raise Error(f"{path} holds {pixels.dtype} of shape {pixels.shape}, which it was not written with", "corrupt")


def _channels(path: Path, names: str) -> list[npt.NDArray[np.float32]]:
    channels = decode_exr(_read(path), str(path))
    for name in names:
        if name not in channels:
            raise Error(f"{path} has no channel {name}, with which it was written", "corrupt")
    return [channels[name] for name in names]


def _by_pillow(path: Path) -> npt.NDArray[np.uint8]:
    try:
        from PIL import Image
    except ImportError as why:
        raise Error(f"{path} is read by Pillow, which is not installed: pip install pillow", "environment") from why
    open_image: Callable[[Any], Any] = Image.open
    try:
        with open_image(io.BytesIO(_read(path))) as picture:
            return np.array(picture.convert("RGB"), np.uint8)
    except (OSError, SyntaxError) as why:
        raise Error(f"{path} is damaged ({why}): 'seedframe resume --verify' makes the frame again", "corrupt") from why


def path_of(campaign: Campaign | StrPath) -> str:
    """The folder of a campaign that is given as one or by its path."""
    return str(campaign.path if isinstance(campaign, Campaign) else Path(campaign))
