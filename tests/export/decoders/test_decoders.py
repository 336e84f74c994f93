"""The measures, rasterisers and the decoders of COCO and YOLO on small examples."""

from __future__ import annotations

import unittest

import check_yolo
import coco
import numpy as np
import polygons
import rle
import yolo
from common import Annotation, Dataset, count_parts, iou, tight_box
from compare import Report
from examples import InFolder, mask_of, png


class Measures(unittest.TestCase):
    def test_tight_box_and_iou(self) -> None:
        mask = mask_of("....", ".##.", ".#..")
        self.assertEqual(tight_box(mask), (1, 1, 2, 2))
        self.assertEqual(tight_box(np.zeros((2, 2), bool)), (0, 0, 0, 0))
        self.assertAlmostEqual(iou(mask, mask_of("....", ".##.", "....")), 2 / 3)

    def test_parts_touch_at_corners(self) -> None:
        self.assertEqual(count_parts(mask_of("#..", ".#.", "..#")), 1)
        self.assertEqual(count_parts(mask_of("..#", ".#.", "#..")), 1)
        self.assertEqual(count_parts(mask_of("#.#", "...", "#.#")), 4)
        self.assertEqual(count_parts(mask_of("#.#", "#.#", "###")), 1)


class RunLengths(unittest.TestCase):
    def test_known_string(self) -> None:
        # 3 is the letter 48 + 3; 40 = 8 + 32 * 1 needs two letters: 48 + 32 + 8 and 48 + 1.
        self.assertEqual(rle.runs_of_text("3X1"), [3, 40])
        # From the fourth number on: the difference to the second before; -1 is 48 + 31.
        self.assertEqual(rle.runs_of_text("321O"), [3, 2, 1, 1])
        self.assertEqual(rle.text_of_runs([3, 2, 1, 1]), "321O")
        # 16 has the sign bit of five, so that a second group must follow.
        self.assertEqual(rle.text_of_runs([16]), "`0")

    def test_columns_first(self) -> None:
        mask = mask_of(".#.", "##.")
        self.assertEqual(rle.runs_of_mask(mask), [1, 3, 2])
        np.testing.assert_array_equal(rle.mask_of_runs([1, 3, 2], 2, 3), mask)
        np.testing.assert_array_equal(rle.decode({"size": [2, 3], "counts": "132"}), mask)
        self.assertEqual(rle.encode(mask_of("#."))["counts"], "011")

    def test_wrong_strings(self) -> None:
        for text in ("3X", "3\x7f", "9"):
            with self.assertRaises(ValueError):
                rle.decode({"size": [2, 2], "counts": text})


class CocoPolygons(unittest.TestCase):
    def test_pixel_edges(self) -> None:
        square = polygons.coco_polygons([[1, 0, 3, 0, 3, 2, 1, 2]], 3, 4)
        np.testing.assert_array_equal(square, mask_of(".##.", ".##.", "...."))
        one = polygons.coco_polygons([[3, 2, 4, 2, 4, 3, 3, 3]], 3, 4)
        np.testing.assert_array_equal(one, mask_of("....", "....", "...#"))

    def test_keyhole_is_a_hole_and_a_ring_is_none(self) -> None:
        keyhole = [0, 0, 1, 0, 1, 1, 1, 2, 2, 2, 2, 1, 1, 1, 1, 0, 3, 0, 3, 3, 0, 3]
        np.testing.assert_array_equal(
            polygons.coco_polygons([keyhole], 3, 3), mask_of("###", "#.#", "###")
        )
        rings = [[0, 0, 3, 0, 3, 3, 0, 3], [1, 1, 1, 2, 2, 2, 2, 1]]
        self.assertTrue(polygons.coco_polygons(rings, 3, 3).all())

    def test_short_ring(self) -> None:
        with self.assertRaises(ValueError):
            polygons.coco_polygons([[0, 0, 1, 1]], 3, 3)


class YoloPolygons(unittest.TestCase):
    def test_outline_is_filled(self) -> None:
        points = np.array([[1, 0], [3, 0], [3, 2], [1, 2]])
        np.testing.assert_array_equal(
            polygons.fill_polygon(points, 4, 5), mask_of(".###.", ".###.", ".###.", ".....")
        )
        dot = polygons.fill_polygon(np.array([[2, 1], [2, 1], [2, 1]]), 3, 4)
        self.assertEqual((dot.sum(), dot[1, 2]), (1, True))

    def test_slanted_edges(self) -> None:
        points = np.array([[0, 0], [4, 2], [0, 2]])
        # Half-way points of the upper edge stay behind: rows 0, 0, 1, 1, 2.
        np.testing.assert_array_equal(
            polygons.fill_polygon(points, 3, 5), mask_of("##...", "####.", "#####")
        )

    def test_truncation(self) -> None:
        numbers = np.array([0.26, 0.01, 0.74, 0.01, 0.74, 0.49, 0.26, 0.49])
        np.testing.assert_array_equal(
            polygons.yolo_polygon(numbers, 4, 4), mask_of(".##.", ".##.", "....", "....")
        )


class OrientedBoxes(unittest.TestCase):
    def test_least_rectangle(self) -> None:
        mask = np.zeros((20, 20), bool)
        for i in range(8):
            mask[5 + i, 5 + i] = True
        hull = check_yolo.hull_of_mask(mask)
        self.assertEqual(len(hull), 6)
        # Along the diagonal: 8 sqrt(2) long, sqrt(2) wide.
        self.assertAlmostEqual(check_yolo.least_area(hull, 20, 20), 16)

    def test_corners_stay_in_the_image(self) -> None:
        # The slanted rectangle of a diagonal from corner to corner has its corners outside.
        hull = check_yolo.hull_of_mask(np.eye(8, dtype=bool))
        self.assertAlmostEqual(check_yolo.least_area(hull, 8, 8), 64)

    def test_checks(self) -> None:
        mask = np.ones((4, 6), bool)
        good = np.array([[0, 0], [6, 0], [6, 4], [0, 4]], float)
        for corners, faults in (
            (good, 0),
            (good[::-1], 0),
            (np.array([[0, 0], [5, 0], [5, 4], [0, 4]], float), 1),
            (np.array([[0, 0], [6, 0], [6, 4], [0, 3]], float), 2),
            (np.array([[0, 0], [7, 0], [7, 4], [0, 4]], float), 1),
        ):
            report = Report("yolo-obb")
            check_yolo.check_rectangle("", corners, mask, report)
            self.assertEqual(len(report.differences), faults, report.differences)


class Coco(InFolder):
    def test_instances(self) -> None:
        self.write(
            "coco/annotations/instances_val.json",
            {
                "categories": [{"id": 1, "name": "nut", "supercategory": "object"}],
                "images": [{"id": 8, "file_name": "000007.png", "width": 3, "height": 2}],
                "annotations": [
                    {"id": 5, "image_id": 8, "category_id": 1, "bbox": [0, 0, 2, 2],
                     "segmentation": {"size": [2, 3], "counts": "132"}},
                ],
            },
        )  # fmt: skip
        self.write("coco/images/val/000007.png", b"image")
        dataset = coco.load(self.folder / "coco")
        (found,) = dataset.annotations
        self.assertEqual((found.stem, found.split, found.name), ("000007", "val", "nut"))
        self.assertEqual(found.box, (0, 0, 2, 2))
        np.testing.assert_array_equal(found.mask, mask_of(".#.", "##."))
        self.assertEqual(dataset.images["000007"](), b"image")
        self.assertEqual(dataset.problems, [])
        self.assertEqual(len(list(coco.read(self.folder / "coco"))), 1)

    def test_panoptic(self) -> None:
        base = "coco-panoptic/annotations/panoptic_train"
        segment = {"id": 258, "category_id": 1, "area": 1, "bbox": [1, 0, 1, 1], "iscrowd": 0}
        nut = {"id": 1, "name": "nut", "isthing": 1, "color": [1, 2, 3]}
        stuff = {"id": 2, "name": "background", "isthing": 0, "color": [3, 2, 1]}
        document = {
            "categories": [nut, stuff],
            "images": [{"id": 1, "file_name": "000000.png", "width": 2, "height": 1}],
            "annotations": [{"image_id": 1, "file_name": "000000.png", "segments_info": [segment]}],
        }
        self.write(f"{base}.json", document)
        self.write(f"{base}/000000.png", png(np.array([[[0, 0, 0], [2, 1, 0]]], np.uint8)))
        (found,) = coco.read(self.folder / "coco-panoptic")
        np.testing.assert_array_equal(found.mask, mask_of(".#"))
        self.write(f"{base}/000000.png", png(np.array([[[3, 0, 0], [2, 1, 0]]], np.uint8)))
        with self.assertRaises(ValueError):
            list(coco.read(self.folder / "coco-panoptic"))
        segments = document["annotations"][0]["segments_info"]
        segments.append({"id": 3, "category_id": 2, "area": 1, "bbox": [0, 0, 1, 1], "iscrowd": 0})
        self.write(f"{base}.json", document)
        dataset = coco.load(self.folder / "coco-panoptic")
        self.assertEqual((dataset.categories, len(dataset.annotations)), (["nut"], 1))
        ((_, mask),) = dataset.extras["stuff"]["000000"]
        np.testing.assert_array_equal(mask, mask_of("#."))


class Yolo(InFolder):
    def load(self, kind: str, row: str, more: str = "") -> Dataset:
        settings = "train: images/train\nval: images/train\n"
        self.write(f"yolo-{kind}/data.yaml", settings + 'names: {0: "a", 1: "b"}\n' + more)
        self.write(f"yolo-{kind}/data_with_nc.yaml", settings + 'nc: 2\nnames: ["a", "b"]\n' + more)
        self.write(f"yolo-{kind}/labels/train/000000.txt", row)
        return yolo.load(self.folder / f"yolo-{kind}", {"000000": (20, 10)})

    def test_detect(self) -> None:
        (found,) = self.load("detect", "1 0.5 0.5 0.2 0.4\n").annotations
        self.assertEqual(found.name, "b")
        np.testing.assert_allclose(found.box, (8, 3, 4, 4))

    def test_segment(self) -> None:
        row = "0 0.101 0.101 0.199 0.101 0.199 0.299 0.101 0.299"
        (found,) = self.load("segment", row).annotations
        self.assertEqual(tight_box(found.mask), (2, 1, 2, 2))
        np.testing.assert_allclose(found.box, (2.02, 1.01, 1.96, 1.98))

    def test_obb_and_pose(self) -> None:
        (found,) = self.load("obb", "0 0 0 0.5 0 0.5 1 0 1").annotations
        self.assertEqual(found.extras["corners"].tolist(), [[0, 0], [10, 0], [10, 10], [0, 10]])
        row = "0 0.5 0.5 0.2 0.4 0.25 0.5 2 0 0 0"
        (found,) = self.load("pose", row, "kpt_shape: [2, 3]").annotations
        self.assertEqual(found.extras["points"].tolist(), [[5, 5, 2], [0, 0, 0]])

    def test_bad_rows(self) -> None:
        for row in ("2 0.5 0.5 0.2 0.4", "0 1.5 0.5 0.2 0.4", "0 0.5 0.5 0.2"):
            self.assertEqual(len(self.load("detect", row).problems), 1, row)


class Comparing(unittest.TestCase):
    def test_annotations_of_an_image_keep_their_order(self) -> None:
        found = [Annotation("1", "train", "b"), Annotation("0", "train", "a")]
        found.append(Annotation("1", "train", "a"))
        dataset = Dataset(["a", "b"], {}, found)
        self.assertEqual([a.name for a in dataset.of_image("1")], ["b", "a"])
        self.assertEqual(dataset.of_image("2"), [])


if __name__ == "__main__":
    unittest.main()
