#!/usr/bin/env python3
"""Exports read by pycocotools and webdataset, which scripts/client_wheels.sh installs.

    venv/clients/bin/python tests/export/clients/clients_test.py PROGRAM

A campaign of a fake Blender is exported by the program, and everything is read back: the ground truth
compared with itself must be perfect.
"""

import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest

import numpy
import PIL.Image
import pycocotools.coco
import pycocotools.cocoeval
import webdataset
from made_campaign import code_of, export
from panoptic_quality import panoptic_quality

PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
FORMATS = ("coco", "coco-polygon", "coco-keypoints", "coco-panoptic", "webdataset")


class Clients(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        export(PROGRAM, cls.folder, FORMATS, "--shard-size", "6")
        cls.ids = {
            path.parent.name: numpy.array(PIL.Image.open(path)).astype(int)
            for path in sorted(cls.folder.glob("c/frames/*/*/instances.png"))
        }

    def coco(self, path):
        with contextlib.redirect_stdout(io.StringIO()):
            return pycocotools.coco.COCO(str(self.folder / "out" / path))

    def average_precision(self, truth, kind):
        """Of the ground truth as detections of itself."""
        found = [dict(annotation, score=1.0) for annotation in truth.dataset["annotations"]]
        with contextlib.redirect_stdout(io.StringIO()):
            evaluation = pycocotools.cocoeval.COCOeval(truth, truth.loadRes(found), kind)
            if kind == "keypoints":
                names = max((c["keypoints"] for c in truth.dataset["categories"]), key=len)
                evaluation.params.kpt_oks_sigmas = numpy.full(len(names), 0.05)
            evaluation.evaluate()
            evaluation.accumulate()
            evaluation.summarize()
        return evaluation.stats[0]

    def test_masks_are_the_frames_own(self):
        for path in (
            "coco/annotations/instances_train.json",
            "coco-polygon/annotations/instances_train.json",
            "coco-keypoints/annotations/person_keypoints_train.json",
        ):
            coco = self.coco(path)
            self.assertGreater(len(coco.anns), 20, path)
            for annotation in coco.anns.values():
                stem = coco.imgs[annotation["image_id"]]["file_name"].split(".")[0]
                number = annotation["id"] - annotation["image_id"] * 100000
                numpy.testing.assert_array_equal(coco.annToMask(annotation), self.ids[stem] == number)

    def test_average_precision_is_1(self):
        for kind, path in (
            ("bbox", "coco/annotations/instances_train.json"),
            ("segm", "coco/annotations/instances_train.json"),
            ("segm", "coco-polygon/annotations/instances_train.json"),
            ("keypoints", "coco-keypoints/annotations/person_keypoints_train.json"),
        ):
            self.assertEqual(self.average_precision(self.coco(path), kind), 1.0, (kind, path))

    def test_panoptic_quality_is_1(self):
        folder = self.folder / "out" / "coco-panoptic" / "annotations"
        document = json.loads((folder / "panoptic_train.json").read_text())
        truth = []
        for annotation in document["annotations"]:
            rgb = numpy.array(PIL.Image.open(folder / "panoptic_train" / annotation["file_name"])).astype(int)
            categories = {segment["id"]: segment["category_id"] for segment in annotation["segments_info"]}
            truth.append((rgb @ [1, 256, 65536], categories))
        qualities = panoptic_quality(zip(truth, truth), [c["id"] for c in document["categories"]])
        for category in document["categories"]:
            expected = None if category["name"] == "never_seen" else 1.0
            self.assertEqual(qualities[category["id"]], expected, category["name"])
        # Evaluations take the mean over things and the mean over stuff: neither may be of nothing.
        for kind in (0, 1):
            occurring = [c for c in document["categories"] if c["isthing"] == kind and qualities[c["id"]]]
            self.assertTrue(occurring)

    def test_webdataset_is_read_as_its_page_says(self):
        names = {"webdataset": webdataset, "numpy": numpy, "PIL": PIL, "io": io}
        exec(code_of("webdataset.md").replace("OUT/", f"{self.folder}/out/"), names)
        samples = {sample["__key__"]: sample for sample in names["samples"]}
        self.assertEqual(sorted(samples), sorted(self.ids))
        for stem, sample in samples.items():
            self.assertEqual(sample["instances.png"].dtype, numpy.uint16)
            annotated = [a["id"] - a["image_id"] * 100000 for a in sample["json"]["annotations"]]
            expected = numpy.where(numpy.isin(self.ids[stem], annotated), self.ids[stem], 0)
            numpy.testing.assert_array_equal(sample["instances.png"], expected)
            (picture,) = self.folder.glob(f"c/frames/*/{stem}/image.png")
            numpy.testing.assert_array_equal(numpy.array(sample["png"]), numpy.array(PIL.Image.open(picture)))


class PanopticQuality(unittest.TestCase):
    """On cases done by hand."""

    def quality(self, truth, found, categories=(1, 2)):
        segments = [
            (numpy.array([[int(letter) for letter in row] for row in rows]), of) for rows, of in (truth, found)
        ]
        return panoptic_quality([tuple(segments)], categories)

    def test_iou_over_matches_and_what_has_none(self):
        truth = (["1112", "1110"], {1: 1, 2: 2})
        self.assertEqual(self.quality(truth, truth), {1: 1.0, 2: 1.0})
        # 5 of 6 pixels; the other segment is not found, and one is found elsewhere.
        found = (["1113", "1100"], {1: 1, 3: 1})
        self.assertEqual(self.quality(truth, found), {1: (5 / 6) / 1.5, 2: 0.0})
        self.assertEqual(self.quality(truth, found, (1, 2, 3))[3], None)

    def test_void_is_neither_right_nor_wrong(self):
        truth = (["1100"], {1: 1})
        self.assertEqual(self.quality(truth, (["1110"], {1: 1})), {1: 1.0, 2: None})
        self.assertEqual(self.quality(truth, (["1122"], {1: 1, 2: 2})), {1: 1.0, 2: None})
        self.assertEqual(self.quality((["1111"], {1: 1}), (["1122"], {1: 1, 2: 2})), {1: 0.0, 2: 0.0})


if __name__ == "__main__":
    unittest.main(warnings="ignore")  # of the programs, about themselves
