"""WebDataset shards: in a tar, members with the same name up to the first dot are a sample."""

from __future__ import annotations

import io
import json
import tarfile
from collections.abc import Iterator
from pathlib import Path

import coco
import numpy as np
from common import PICTURES, Annotation, Dataset
from PIL import Image

LABELS = {"json", "instances.png"}


def samples_of_shard(data: bytes) -> Iterator[tuple[str, dict[str, bytes]]]:
    """Key and members by extension; ValueError where the members of a sample do not follow each
    other, an extension occurs twice, or a header is not the documented one."""
    done: set[str] = set()
    key, sample = "", {}
    with tarfile.open(fileobj=io.BytesIO(data), mode="r:") as archive:
        for member in archive:
            owner = (member.uid, member.gid, member.mtime, member.mode)
            if not member.isreg() or owner != (0, 0, 0, 0o644):
                raise ValueError(f"{member.name}: owner, time or mode is {owner}")
            if data[member.offset + 257 : member.offset + 265] != b"ustar\x0000":
                raise ValueError(f"{member.name}: not POSIX ustar")
            stem, _, extension = member.name.partition(".")
            if stem != key:
                if sample:
                    yield key, sample
                if stem in done:
                    raise ValueError(f"{member.name}: apart from the rest of its sample")
                key, sample = stem, {}
                done.add(stem)
            if extension in sample:
                raise ValueError(f"{member.name} occurs twice")
            sample[extension] = archive.extractfile(member).read()
    if sample:
        yield key, sample


def _read_sample(stem: str, split: str, sample: dict[str, bytes], dataset: Dataset) -> None:
    entry = json.loads(sample["json"])
    ids = np.array(Image.open(io.BytesIO(sample["instances.png"])))
    size = entry["height"], entry["width"]
    if ids.shape != size:
        dataset.problems.append(f"{stem}: instances.png has another size than the JSON says")
    pictures = sample.keys() - LABELS
    good = len(pictures) <= 1 and {f".{name}" for name in pictures} <= PICTURES.keys()
    if not LABELS <= sample.keys() or not good:
        dataset.problems.append(f"{stem}: members {sorted(sample)}")
    if entry["frame"] != int(stem) or entry["image_id"] != int(stem) + 1:
        dataset.problems.append(f"{stem}: JSON of frame {entry['frame']}")
    dataset.splits[split].append(stem)
    dataset.scenes[stem] = entry["scene"]
    dataset.extras["images"][stem] = {k: v for k, v in entry.items() if k != "annotations"}
    for name in pictures:
        dataset.images[stem] = lambda: sample[name]
    left = ids.copy()
    for row in entry["annotations"]:
        image = {"file_name": stem, "height": size[0], "width": size[1]}
        annotation = coco.annotation_of(row, image, row["category"], split)
        number = row["id"] - entry["image_id"] * 100000
        annotation.extras["ids_mask"] = ids == number
        left[left == number] = 0
        dataset.annotations.append(annotation)
        if row["image_id"] != entry["image_id"]:
            dataset.problems.append(f"{stem}: an annotation of image {row['image_id']}")
        dataset.extras["names"].setdefault(row["category_id"], row["category"])
    if left.any():
        dataset.problems.append(f"{stem}: instances.png has instances without annotation")


def load(folder: Path) -> Dataset:
    """Everything in `OUT/webdataset`. Shards list no classes: `categories` are those that occur."""
    dataset = Dataset([], {}, [], extras={"images": {}, "names": {}, "shards": {}})
    for path in sorted(Path(folder).glob("*-[0-9]*.tar")):
        split, _, number = path.stem.rpartition("-")
        shards = dataset.extras["shards"].setdefault(split, [])
        if len(number) != 6 or int(number) != len(shards):
            dataset.problems.append(f"{path.name}: shards are not numbered 0, 1, ...")
        before = len(dataset.splits.setdefault(split, []))
        for stem, sample in samples_of_shard(path.read_bytes()):
            _read_sample(stem, split, sample, dataset)
        shards.append(len(dataset.splits[split]) - before)
    for split, shards in dataset.extras["shards"].items():
        if any(count != shards[0] for count in shards[:-1]) or shards[-1] > shards[0]:
            dataset.problems.append(f"{split}: shards of {shards} samples")
    dataset.categories = [dataset.extras["names"][i] for i in sorted(dataset.extras["names"])]
    return dataset


def read(folder: Path) -> Iterator[Annotation]:
    """The annotations of all splits."""
    yield from load(folder).annotations
