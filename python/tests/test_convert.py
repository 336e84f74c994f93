import importlib
import sys
import types
import unittest
from unittest import mock

import numpy as np
import support  # noqa: F401, so that the package is found
from support import FAKE_BLENDER, ProgramTest

import seedframe
from seedframe import Error


class Kept:
    """What the real classes are given, for tests without them."""

    def __init__(self, *positional, **named):
        self.positional, self.named, self.fields, self.samples = positional, named, {}, []

    def __setitem__(self, name, value):
        self.fields[name] = value

    def add_sample(self, sample):
        self.samples.append(sample)


def module(name, *classes):
    made = types.ModuleType(name)
    for each in classes:
        setattr(made, each, type(each, (Kept,), {}))
    return made


class Converted(ProgramTest):
    def setUp(self):
        super().setUp()
        self.campaign = seedframe.submit(self.config, self.folder / "c", blender=FAKE_BLENDER, frames=2)

    def test_supervision(self):
        frame = self.campaign[0]
        with mock.patch.dict(sys.modules, supervision=module("supervision", "Detections")):
            named = seedframe.to_supervision(frame).named
        count = len(frame.labels.visible)
        self.assertGreater(count, 0)
        self.assertEqual(named["xyxy"].shape, (count, 4))
        self.assertEqual(named["mask"].shape, (count, 32, 48))
        self.assertEqual(named["class_id"].tolist(), [0] * count)
        self.assertEqual(named["data"]["class_name"].tolist(), ["gear"] * count)
        for (left, top, right, bottom), mask in zip(named["xyxy"].astype(int), named["mask"]):
            self.assertEqual(mask[top:bottom, left:right].sum(), mask.sum())

    def test_fiftyone(self):
        classes = ("Dataset", "Sample", "Detection", "Detections")
        with mock.patch.dict(sys.modules, fiftyone=module("fiftyone", *classes)):
            dataset = seedframe.to_fiftyone(self.campaign, "mine")
        self.assertEqual(dataset.positional, ("mine",))
        self.assertEqual([sample.fields["frame_number"] for sample in dataset.samples], [0, 1])
        for sample, frame in zip(dataset.samples, self.campaign):
            self.assertEqual(sample.named["filepath"], str(frame.image_path))
            for detection, each in zip(sample.fields["ground_truth"].named["detections"], frame.labels.visible):
                self.assertTrue(np.all(np.array(detection.named["bounding_box"]) <= 1))
                self.assertEqual(detection.named["mask"].sum(), each.area_px)

    def test_what_is_not_installed_is_named(self):
        with mock.patch.dict(sys.modules, supervision=None), self.assertRaisesRegex(Error, "pip install supervision"):
            seedframe.to_supervision(self.campaign[0])
        with mock.patch.dict(sys.modules, fiftyone=None), self.assertRaisesRegex(Error, "pip install fiftyone"):
            seedframe.to_fiftyone(self.campaign)
        with mock.patch.dict(sys.modules, torch=None), self.assertRaisesRegex(Error, "pip install torch"):
            importlib.import_module("seedframe.torch")


if __name__ == "__main__":
    unittest.main()
