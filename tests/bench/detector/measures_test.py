#!/usr/bin/python3
"""Tests of what the detector is taught, of its boxes, and of their average precision, on cases done by hand."""

import pathlib
import sys
import unittest

import numpy

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from average_precision import average_precision, match  # noqa: E402
from boxes import STRIDE, boxes_of, iou, mirrored, moved, targets  # noqa: E402
from scores import Outcome, differences, scores_of, spread_of_seeds  # noqa: E402


def boxes(*rows):
    return numpy.array(rows, numpy.float32).reshape(-1, 4)


def matched(found, truth, classes=1):
    """Of one picture: found as (box, category, score), truth as (box, category)."""
    return match(boxes(*(box for box, _, _ in found)), numpy.array([c for _, c, _ in found], int),
                 numpy.array([score for _, _, score in found]), boxes(*(box for box, _ in truth)),
                 numpy.array([c for _, c in truth], int), classes)


class Iou(unittest.TestCase):
    def test_is_the_share_of_the_union(self):
        found = iou(boxes([0, 0, 2, 2]), boxes([0, 0, 2, 2], [1, 0, 3, 2], [2, 0, 4, 2], [0, 0, 1, 1]))
        numpy.testing.assert_allclose(found, [[1, 1 / 3, 0, 1 / 4]], rtol=1e-6)

    def test_of_boxes_without_area_is_nothing(self):
        self.assertEqual(iou(boxes([1, 1, 1, 1]), boxes([1, 1, 1, 1]))[0, 0], 0)
        self.assertEqual(iou(boxes(), boxes([0, 0, 1, 1])).shape, (0, 1))


class Moved(unittest.TestCase):
    def test_boxes_are_cut_and_forgotten_when_less_than_half_is_left(self):
        cut, kept = moved(boxes([0, 0, 10, 10], [20, 0, 30, 10]), -6, 0, 40, 40)
        numpy.testing.assert_array_equal(cut, [[0, 0, 4, 10], [14, 0, 24, 10]])
        numpy.testing.assert_array_equal(kept, [False, True])

    def test_mirroring_twice_changes_nothing(self):
        one = boxes([3, 1, 10, 4])
        numpy.testing.assert_array_equal(mirrored(one, 40), [[30, 1, 37, 4]])
        numpy.testing.assert_array_equal(mirrored(mirrored(one, 40), 40), one)


class Targets(unittest.TestCase):
    def test_come_back_as_the_boxes_that_they_were_made_of(self):
        truth = boxes([10, 20, 31, 37], [50, 8, 58, 15], [70, 60, 76, 90], [0, 0, 5, 5], [122, 90, 128, 96])
        heat, sides, _ = targets(truth, numpy.array([0, 1, 2, 1, 0]), 3, 128, 96)
        found, categories, scores = boxes_of(heat, sides, least=0.99)
        order = numpy.lexsort((found[:, 1], found[:, 0]))
        numpy.testing.assert_allclose(found[order], truth[numpy.lexsort((truth[:, 1], truth[:, 0]))], atol=1e-4)
        self.assertEqual(sorted(categories), [0, 0, 1, 1, 2])
        numpy.testing.assert_array_equal(scores, 1)

    def test_have_the_grids_shape_and_one_weight_for_each_box(self):
        heat, sides, weights = targets(boxes([10, 20, 31, 37], [64, 8, 72, 16]), numpy.array([0, 1]), 2, 128, 96)
        self.assertEqual((heat.shape, sides.shape, weights.shape), ((2, 24, 32), (4, 24, 32), (24, 32)))
        self.assertAlmostEqual(float(weights.sum()), 2, places=5)
        self.assertEqual((heat[0] == 1).sum(), 1)

    def test_of_an_empty_picture_are_cold(self):
        heat, _, weights = targets(boxes(), numpy.zeros(0, int), 2, 128, 96)
        self.assertEqual((heat.sum(), weights.sum()), (0, 0))
        self.assertEqual(len(boxes_of(heat, numpy.zeros((4, 24, 32)))[0]), 0)

    def test_the_smaller_of_two_boxes_has_the_cell_of_both(self):
        truth = boxes([20, 20, 60, 60], [37, 37, 43, 43])
        for order in ([0, 1], [1, 0]):
            _, sides, _ = targets(truth[order], numpy.array([0, 0]), 1, 128, 96)
            numpy.testing.assert_allclose(sides[:, 10, 10], [42 - 37, 42 - 37, 43 - 42, 43 - 42])


class BoxesOf(unittest.TestCase):
    def test_are_peaks_surest_first_and_end_at_the_edge(self):
        heat = numpy.zeros((2, 24, 32))
        heat[0, 5, 5], heat[0, 5, 6], heat[1, 0, 0] = 0.6, 0.5, 0.9
        found, categories, scores = boxes_of(heat, numpy.full((4, 24, 32), 6.0))
        x = 5.5 * STRIDE
        numpy.testing.assert_array_equal(found, [[0, 0, 8, 8], [x - 6, x - 6, x + 6, x + 6]])
        numpy.testing.assert_array_equal(categories, [1, 0])
        numpy.testing.assert_array_equal(scores, [0.9, 0.6])
        self.assertEqual(len(boxes_of(heat, numpy.ones((4, 24, 32)), most=1)[0]), 1)


class AveragePrecision(unittest.TestCase):
    FIRST, SECOND, ELSEWHERE = [0, 0, 10, 10], [20, 20, 30, 30], [50, 50, 60, 60]

    def test_of_the_truth_itself_is_one(self):
        one = matched([(self.FIRST, 0, 0.9), (self.SECOND, 1, 0.8)], [(self.FIRST, 0), (self.SECOND, 1)], 2)
        numpy.testing.assert_allclose(average_precision([one]), 1)

    def test_a_wrong_box_between_two_right_ones_costs_a_third_of_the_upper_half(self):
        one = matched([(self.FIRST, 0, 0.9), (self.ELSEWHERE, 0, 0.8), (self.SECOND, 0, 0.7)],
                      [(self.FIRST, 0), (self.SECOND, 0)])
        # Precision 1 at the 51 recalls to 0.5, then 2/3 at the other 50.
        numpy.testing.assert_allclose(average_precision([one]), (51 + 50 * 2 / 3) / 101)

    def test_the_threshold_decides(self):
        one = matched([([0, 0, 10, 8], 0, 0.9)], [(self.FIRST, 0)])  # IoU 0.8
        numpy.testing.assert_allclose(average_precision([one])[[0, 5, 7, 9]], [1, 1, 0, 0])

    def test_a_second_box_of_the_same_object_is_wrong(self):
        twice = [(self.FIRST, 0, 0.9), (self.FIRST, 0, 0.8)]
        one = matched(twice, [(self.FIRST, 0), (self.SECOND, 0)])
        numpy.testing.assert_allclose(average_precision([one]), 51 / 101)
        self.assertEqual(one.hits.sum(axis=1).tolist(), [1] * 10)

    def test_another_class_at_the_right_place_is_wrong_and_classes_count_alike(self):
        one = matched([(self.FIRST, 1, 0.9), (self.SECOND, 1, 0.8)], [(self.FIRST, 0), (self.SECOND, 1)], 3)
        # Class 0 is not found; class 1 after a wrong box; class 2 does not occur.
        numpy.testing.assert_allclose(average_precision([one]), (0 + 1 / 2) / 2)

    def test_scores_are_compared_over_all_pictures(self):
        pictures = [matched([(self.FIRST, 0, 0.5)], [(self.FIRST, 0)]), matched([(self.FIRST, 0, 0.9)], [])]
        numpy.testing.assert_allclose(average_precision(pictures), 0.5)
        numpy.testing.assert_allclose(average_precision(pictures[:1]), 1)

    def test_nothing_found_is_zero(self):
        numpy.testing.assert_array_equal(average_precision([matched([], [(self.FIRST, 0)])]), 0)


class Scores(unittest.TestCase):
    FOUND, MISSED = [([0, 0, 10, 10], 0, 0.9)], []

    def outcome(self, *found, right):
        """Of a picture for each of found, with one object and two patches each."""
        pictures = len(found)
        return Outcome([matched(each, [([0, 0, 10, 10], 0)]) for each in found], numpy.array(right), numpy.full(pictures, 2))

    def test_are_percent_of_objects_and_of_patches(self):
        scores = scores_of([self.outcome(self.FOUND, self.FOUND, right=[2, 1])])
        self.assertEqual(scores, {"ap": [100], "ap50": [100], "top1": [75]})

    def test_spread_is_that_within_datasets_and_not_between_them(self):
        of = [{"ap": values, "ap50": values, "top1": values} for values in ([1, 3], [101, 103], [7])]
        self.assertAlmostEqual(spread_of_seeds(of)["ap"], 2 ** 0.5)
        self.assertEqual(spread_of_seeds(of[2:])["ap"], 0)

    def test_a_difference_that_all_pictures_show_has_the_error_of_the_trainings_alone(self):
        good = [self.outcome(self.FOUND, self.FOUND, right=[2, 2])] * 2
        bad = [self.outcome(self.MISSED, self.MISSED, right=[1, 1])] * 2
        found = differences({"good": good, "bad": bad}, "good", {"ap": 3, "ap50": 0, "top1": 0})
        self.assertEqual(found["good"]["top1"], (0, 0))
        self.assertEqual(found["bad"]["top1"], (-50, 0))
        self.assertEqual(found["bad"]["ap"], (-100, 3))

    def test_a_difference_in_half_of_the_pictures_has_the_error_of_which_were_drawn(self):
        good = [self.outcome(self.FOUND, self.FOUND, right=[2, 2])]
        mixed = [self.outcome(self.FOUND, self.FOUND, right=[0, 2])]
        found = differences({"good": good, "mixed": mixed}, "good", {"ap": 0, "ap50": 0, "top1": 0})
        difference, error = found["mixed"]["top1"]
        self.assertEqual(difference, -50)
        self.assertAlmostEqual(error, 100 * 0.5 / 2 ** 0.5, delta=4)  # of the mean of two draws of 0 or -100


if __name__ == "__main__":
    unittest.main()
