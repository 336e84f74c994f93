"""Datasets of the study: rendered by `seedframe submit`, written by `seedframe export`, read from what that wrote."""

import dataclasses
import json
import os
import pathlib
import resource
import subprocess
import sys

import numpy
from PIL import Image

HOME = pathlib.Path(__file__).resolve().parents[3]
CONFIG = pathlib.Path(__file__).with_name("parts_near.yaml")
LEAST_PIXELS, LEAST_VISIBLE = 20, 0.3  # of an object that is to be found


@dataclasses.dataclass(frozen=True)
class Setting:
    """How frames are rendered."""
    samples: int
    denoised: bool = False
    threshold: float = 0  # of adaptive sampling; 0: every pixel gets all samples

    def name(self):
        return f"{self.samples}{'-denoised' if self.denoised else ''}"

    def overrides(self):
        words = [f"render.samples={self.samples}"]
        if self.denoised:
            words.append("render.denoise=oidn_fast")
        if self.threshold:
            words.append(f"render.adaptive={{threshold: {self.threshold}, min_samples: 32}}")
        return words


@dataclasses.dataclass
class Dataset:
    images: numpy.ndarray            # [frames, height, width, 3], sRGB of 8 bits
    boxes: list                      # of each frame [objects, 4]: x0, y0, x1, y1 in pixels
    categories: list                 # of each frame [objects]
    patches: numpy.ndarray           # [objects of all frames, 32, 32, 3]
    patch_categories: numpy.ndarray
    patch_frames: numpy.ndarray

    def first(self, frames):
        kept = self.patch_frames < frames
        return Dataset(self.images[:frames], self.boxes[:frames], self.categories[:frames], self.patches[kept],
                       self.patch_categories[kept], self.patch_frames[kept])

    def joined(self, other):
        return Dataset(numpy.concatenate([self.images, other.images]), self.boxes + other.boxes,
                       self.categories + other.categories, numpy.concatenate([self.patches, other.patches]),
                       numpy.concatenate([self.patch_categories, other.patch_categories]),
                       numpy.concatenate([self.patch_frames, other.patch_frames + len(self.images)]))


class Campaigns:
    """Campaigns in a folder. One that is there is not rendered again: its cost was written beside it."""

    def __init__(self, program, blender, folder):
        self.program = program
        self.blender = blender
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)

    def render(self, name, setting, seed, frames):
        """CPU seconds of `submit` and all its children, from its start to its end."""
        cost = self.folder / f"{name}.json"
        if not cost.exists():
            before = children_cpu_s()
            run([self.program, "submit", CONFIG, "-o", self.folder / name, "--quiet", "--blender", self.blender,
                 "--workers", os.cpu_count(), "--threads", 1,
                 *(word for each in (f"seed={seed}", f"scenes={frames}", *setting.overrides())
                   for word in ("--set", each))])
            seconds = children_cpu_s() - before
            cost.write_text(json.dumps({"frames": frames, "cpu_s": seconds}), encoding="utf-8")
            print(f"{name}: {frames} frames in {seconds:.1f} CPU s", file=sys.stderr, flush=True)
        return json.loads(cost.read_text(encoding="utf-8"))["cpu_s"]

    def load(self, name):
        """The dataset, and the names of its classes."""
        exports = self.folder / name / "exports"
        run([self.program, "export", self.folder / name, "--format", "coco", "--format", "patches",
             "--min-pixels", LEAST_PIXELS, "--min-visible", LEAST_VISIBLE])
        coco = json.loads((exports / "coco/annotations/instances_train.json").read_text(encoding="utf-8"))
        images, objects = [], {image["id"]: [] for image in coco["images"]}
        for image in coco["images"]:
            images.append(pixels(exports / "coco/images/train" / image["file_name"]))
        for each in coco["annotations"]:
            x, y, width, height = each["bbox"]
            objects[each["image_id"]].append([x, y, x + width, y + height, each["category_id"] - 1])
        rows = [numpy.array(found, numpy.float32).reshape(-1, 5) for found in objects.values()]
        classes = json.loads((exports / "patches/classes.json").read_text(encoding="utf-8"))
        patches = [(pixels(path), category, int(path.name.split("_")[0]))
                   for category, each in enumerate(classes)
                   for path in sorted((exports / "patches/train" / each["folder"]).glob("*.png"))]
        return Dataset(numpy.stack(images), [row[:, :4] for row in rows], [row[:, 4].astype(int) for row in rows],
                       *(numpy.array(column) for column in zip(*patches))), [each["name"] for each in coco["categories"]]


def pixels(path):
    with Image.open(path) as image:
        return numpy.asarray(image.convert("RGB"))


def children_cpu_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(command):
    """What it printed."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, cwd=HOME,
                          env={**os.environ, "SEEDFRAME_CACHE": "off"})
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}:\n{done.stderr}")
    return done.stdout
