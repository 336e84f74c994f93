#!/usr/bin/env python3
"""Exports read and trained on by torchvision, torchmetrics, webdataset and ultralytics, which scripts/trainer_wheels.sh
installs (6 GB).

    venv/trainers/bin/python tests/export/clients/trainers_test.py PROGRAM

A campaign of a fake Blender is exported by the program. Networks start from nothing and train for one epoch: what is
tested is that the readers take every file as it is meant, without a warning, not what is learned.
"""

import contextlib
import io
import json
import logging
import os
import pathlib
import sys
import tempfile
import unittest

SCRATCH = tempfile.TemporaryDirectory()
os.environ["YOLO_CONFIG_DIR"] = SCRATCH.name  # no settings of anybody's, and none left behind
os.environ["YOLO_OFFLINE"] = "1"
os.environ["WANDB_DISABLED"] = "true"

import numpy  # noqa: E402
import PIL.Image  # noqa: E402
import torch  # noqa: E402
import torchmetrics.detection  # noqa: E402
import torchvision  # noqa: E402
import torchvision.transforms.v2 as transforms  # noqa: E402
import ultralytics  # noqa: E402
import webdataset  # noqa: E402
from made_campaign import export  # noqa: E402

PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
FORMATS = ("coco", "voc", "patches", "webdataset", "yolo-detect", "yolo-segment", "yolo-obb", "yolo-pose")
SIDE = 160


class Trainers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(SCRATCH.name) / "work"
        cls.folder.mkdir()
        export(PROGRAM, cls.folder, FORMATS, "--split", "train=0.5,val=0.5", "--shard-size", "3", scenes=8)
        cls.out = cls.folder / "out"
        cls.frames = sorted(cls.folder.glob("c/frames/*/*"))

    def coco(self, split):
        transform = transforms.Compose([transforms.ToImage(), transforms.Resize((240, 320))])
        with contextlib.redirect_stdout(io.StringIO()):
            plain = torchvision.datasets.CocoDetection(
                self.out / "coco/images" / split, self.out / f"coco/annotations/instances_{split}.json", transforms=transform
            )
        return torchvision.datasets.wrap_dataset_for_transforms_v2(plain, target_keys=("boxes", "labels", "masks"))

    def test_coco_detection_with_transforms(self):
        for split in ("train", "val"):
            dataset = self.coco(split)
            self.assertGreater(len(dataset), 0)
            for image, target in dataset:
                self.assertEqual(tuple(image.shape), (3, 240, 320))
                self.assertEqual(len(target["boxes"]), len(target["masks"]))
                self.assertEqual(tuple(target["masks"].shape[1:]), (240, 320))
                self.assertTrue((target["boxes"][:, 2:] > target["boxes"][:, :2]).all())

    def test_mean_average_precision_is_1(self):
        for kind in ("bbox", "segm"):
            metric = torchmetrics.detection.MeanAveragePrecision(iou_type=kind)
            for _, target in self.coco("train"):
                truth = {"boxes": target["boxes"], "labels": target["labels"], "masks": target["masks"].bool()}
                metric.update([truth | {"scores": torch.ones(len(target["labels"]))}], [truth])
            self.assertEqual(float(metric.compute()["map"]), 1.0, kind)

    def test_voc_detection_and_segmentation(self):
        for split in ("train", "val"):
            detection = torchvision.datasets.VOCDetection(self.out / "voc", image_set=split, download=False)
            segmentation = torchvision.datasets.VOCSegmentation(self.out / "voc", image_set=split, download=False)
            self.assertEqual(len(detection), len(segmentation))
            for (image, target), (_, mask) in zip(detection, segmentation):
                annotation = target["annotation"]
                self.assertEqual(image.size, (int(annotation["size"]["width"]), int(annotation["size"]["height"])))
                classes = set(numpy.unique(numpy.array(mask))) - {0, 255}
                self.assertEqual(len(classes), len({each["name"] for each in annotation["object"]}))

    def test_image_folder(self):
        train = torchvision.datasets.ImageFolder(self.out / "patches/train")
        val = torchvision.datasets.ImageFolder(self.out / "patches/val", allow_empty=True)
        self.assertEqual(train.class_to_idx, val.class_to_idx)
        self.assertEqual(sorted(train.classes), ["gear", "hex_bolt", "washer"])
        self.assertTrue(all(image.size == (32, 32) for image, _ in train))

    def test_webdataset_through_a_loader(self):
        shards = [str(path) for path in sorted(self.out.glob("webdataset/train-*.tar"))]
        self.assertGreater(len(shards), 1)

        def ids(data):
            return numpy.array(PIL.Image.open(io.BytesIO(data))).astype(numpy.int32)

        def decoded(sample):
            return sample["__key__"], ids(sample["instances.png"]), json.loads(sample["json"])

        pipeline = webdataset.WebDataset(shards, shardshuffle=False, empty_check=False).map(decoded)
        loader = torch.utils.data.DataLoader(pipeline, batch_size=None, num_workers=2)
        found = {stem: (image, labels) for stem, image, labels in loader}
        names = {path.name: path for path in self.frames}
        pictures = list(self.out.glob("coco/images/train/*"))
        self.assertEqual(sorted(found), sorted(path.stem for path in pictures))
        for stem, (image, labels) in found.items():
            annotated = [each["id"] - each["image_id"] * 100000 for each in labels["annotations"]]
            stored = numpy.array(PIL.Image.open(names[stem] / "instances.png")).astype(int)
            expected = numpy.where(numpy.isin(stored, annotated), stored, 0)
            numpy.testing.assert_array_equal(numpy.asarray(image), expected)


class Warnings(logging.Handler):
    def __init__(self):
        super().__init__(logging.WARNING)
        self.said = []

    def emit(self, record):
        self.said.append(record.getMessage())


class Ultralytics(unittest.TestCase):
    """`yolo <task> train` and `val`, without one warning."""

    @classmethod
    def setUpClass(cls):
        cls.out = Trainers.out

    def train(self, task, network, data, **options):
        warnings = Warnings()
        ultralytics.utils.LOGGER.addHandler(warnings)
        ultralytics.utils.LOGGER.setLevel(logging.WARNING)
        try:
            model = ultralytics.YOLO(network, task=task)
            common = {
                "data": str(data), "imgsz": SIDE if task != "classify" else 32, "device": "cpu", "workers": 0,
                "plots": False, "project": f"{SCRATCH.name}/runs", "name": task, "verbose": False,
            }
            model.train(epochs=1, batch=4, pretrained=False, amp=False, val=False, **options, **common)
            metrics = model.val(split="val", **common)
        finally:
            ultralytics.utils.LOGGER.removeHandler(warnings)
        self.assertEqual(warnings.said, [], task)
        return metrics

    def test_detect(self):
        metrics = self.train("detect", "yolov8n.yaml", self.out / "yolo-detect/data.yaml")
        self.assertEqual(sorted(metrics.names.values()), ["gear", "hex_bolt", "never_seen", "washer"])

    def test_segment(self):
        self.train("segment", "yolov8n-seg.yaml", self.out / "yolo-segment/data.yaml")

    def test_oriented_boxes(self):
        self.train("obb", "yolov8n-obb.yaml", self.out / "yolo-obb/data.yaml")

    def test_pose(self):
        # Bolts and gears have no left and right: there is no flip_idx, and as our page says nothing may be mirrored.
        self.train("pose", "yolov8n-pose.yaml", self.out / "yolo-pose/data.yaml", fliplr=0.0)

    def test_classify(self):
        self.train("classify", "yolov8n-cls.yaml", self.out / "patches")


if __name__ == "__main__":
    unittest.main()
