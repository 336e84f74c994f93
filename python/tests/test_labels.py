import json
import unittest

import numpy as np
import support

from seedframe import Error, Labels
from seedframe.labels import decode_rle
from seedframe.views import FrameViews

# The example of docs/formats/labels.md; its run lengths are cut short there.
PAGE = (support.CHECKOUT / "docs/formats/labels.md").read_text()
EXAMPLE = json.loads(PAGE.split("```json")[1].split("```")[0])


def encode_rle(mask):
    """COCO's packing, by its definition."""
    column = mask.T.reshape(-1).astype(int)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], column]))).tolist()
    runs = np.diff([0, *edges, len(column)]).tolist()
    text = ""
    for i, run in enumerate(runs):
        x = run - (runs[i - 2] if i > 2 else 0)
        more = True
        while more:
            bits = x & 0x1F
            x >>= 5
            more = x != -1 if bits & 0x10 else x != 0
            text += chr((bits | 0x20 if more else bits) + 48)
    return text


class View(FrameViews):
    def __init__(self, labels, ids):
        self._labels, self._ids = labels, ids

    @property
    def labels(self):
        return self._labels

    @property
    def ids(self):
        return self._ids


class LabelsTest(unittest.TestCase):
    def test_the_example_of_the_page(self):
        labels = Labels(EXAMPLE)
        (nut,) = labels.instances
        self.assertEqual((nut.id, nut.name, nut.asset, nut.category_name), (5, "nut/0", "hex_nut", "hex_nut"))
        self.assertEqual(nut.box_xyxy, (212, 96, 270, 137))
        self.assertEqual(nut.keypoints[0].px, (240.7, 118.2))
        self.assertTrue(np.isnan(nut.amodal.box_corners_px[7]).all())
        self.assertEqual(labels.boxes.tolist(), [[212, 96, 270, 137]])
        np.testing.assert_array_equal(labels.camera.matrix, [[610.2, 0, 319.5], [0, 610.2, 239.5], [0, 0, 1]])

    def test_poses_project_to_the_corners_of_the_box(self):
        labels = Labels(EXAMPLE)
        pose = labels.instances[0].amodal.pose
        self.assertEqual(pose.matrix.shape, (4, 4))
        origin = pose.matrix_opencv @ [0, 0, 0, 1]
        self.assertGreater(origin[2], 0)  # ahead, for OpenCV
        np.testing.assert_array_equal(origin[:3], pose.translation_m * [1, -1, -1])

    def test_another_version_is_refused(self):
        for other in ({**EXAMPLE, "version": 4}, {}, []):
            with self.assertRaisesRegex(Error, "reads version 3"):
                Labels(other)

    def test_an_id_that_is_not_there(self):
        with self.assertRaisesRegex(Error, "no instance has id 7; there are 5"):
            Labels(EXAMPLE).instance(7)

    def test_run_lengths(self):
        random = np.random.default_rng(3)
        for share in (0.0, 0.05, 0.5, 0.95, 1.0):
            for shape in ((1, 1), (3, 50), (50, 3), (120, 90)):
                mask = random.random(shape) < share
                np.testing.assert_array_equal(decode_rle(encode_rle(mask), *shape), mask)

    def test_damaged_run_lengths(self):
        text = encode_rle(np.eye(9, dtype=bool))
        for bad in (text[:-1], text + "1", "", text[:3] + "o" + text[4:]):
            with self.assertRaisesRegex(Error, "damaged"):
                decode_rle(bad, 9, 9)

    def test_masks_and_silhouettes(self):
        raw = json.loads(json.dumps(EXAMPLE))
        raw["width"], raw["height"] = 6, 4
        silhouette = np.array([[1, 1, 0], [1, 1, 1]], bool)
        raw["instances"][0]["amodal"].update(box=[4, -1, 3, 2], rle=encode_rle(silhouette))
        ids = np.zeros((4, 6), np.uint16)
        ids[0, 4] = 5
        frame = View(Labels(raw), ids)
        self.assertEqual(np.argwhere(frame.mask(5)).tolist(), [[0, 4]])
        self.assertEqual(np.argwhere(frame.amodal_mask(5)).tolist(), [[0, 4], [0, 5]])
        self.assertEqual(frame.masks().shape, (1, 4, 6))
        self.assertEqual(frame._semantic_of_ids()[0, 4], 2)

    def test_no_instance(self):
        frame = View(Labels({**EXAMPLE, "instances": []}), np.zeros((480, 640), np.uint16))
        self.assertEqual(frame.masks().shape, (0, 480, 640))
        self.assertEqual(frame.labels.boxes.shape, (0, 4))


if __name__ == "__main__":
    unittest.main()
