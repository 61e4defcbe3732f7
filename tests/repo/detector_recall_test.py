#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The judging of scripts/detector_recall.py, which needs no network and no model."""
import collections
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import detector_recall as dr  # noqa: E402

CHAIR = {"instance": 1, "name": "armchair", "category": "chair", "box": [100, 100, 200, 200]}
WINDOW = {"instance": 2, "name": "window", "category": "", "box": [300, 0, 400, 100]}
VIEW = {"category": "chair", "box": CHAIR["box"], "objects": [CHAIR, WINDOW]}


class Judging(unittest.TestCase):
    def test_overlap_is_intersection_over_union(self):
        self.assertEqual(dr.iou([0, 0, 10, 10], [0, 0, 10, 10]), 1)
        self.assertAlmostEqual(dr.iou([0, 0, 10, 10], [5, 0, 15, 10]), 1 / 3)
        self.assertEqual(dr.iou([0, 0, 10, 10], [10, 0, 20, 10]), 0)

    def test_a_box_that_fits_is_recognised(self):
        self.assertEqual(dr.judge(VIEW, [("chair", 0.4, [105, 95, 200, 205])]), (True, True, None))

    def test_a_small_box_inside_counts_by_its_centre_only(self):
        self.assertEqual(dr.judge(VIEW, [("chair", 0.4, [140, 140, 160, 160])]),
                         (False, True, None))

    def test_the_wrong_class_is_named(self):
        self.assertEqual(dr.judge(VIEW, [("sofa", 0.9, CHAIR["box"])]), (False, False, "sofa"))

    def test_a_detection_on_something_else_is_a_false_alarm(self):
        found = [("chair", 0.9, CHAIR["box"]), ("tv_monitor", 0.5, [300, 5, 400, 95]),
                 ("sofa", 0.4, [500, 500, 600, 600])]
        self.assertEqual(dr.false_alarms(VIEW, found),
                         [("tv_monitor", "window"), ("sofa", "nothing")])

    def test_suppression_keeps_the_best_of_a_class(self):
        box = [0, 0, 100, 100]
        found = [("chair", 0.5, [0, 0, 100, 98]), ("chair", 0.9, box), ("sofa", 0.4, box)]
        self.assertEqual(dr.suppress(found), [("chair", 0.9, box), ("sofa", 0.4, box)])

    def test_the_table_has_a_row_for_each_category_and_the_sum(self):
        counts = {category: collections.Counter() for category in dr.COCO}
        counts["bed"].update(views=4, box=3, centre=4)
        counts["chair"].update(views=4, box=1, centre=1)
        rows = dr.table(counts, collections.Counter({("bed", "couch"): 2}))
        self.assertIn("| bed | 4 | 3 | 0.75 | 1.00 | 0.25 |", rows)
        self.assertIn("| plant | 0 | 0 | - | - | 0.00 |", rows)
        self.assertIn("| **all** | 8 | 4 | 0.50 | 0.62 | 0.25 |", rows)


if __name__ == "__main__":
    unittest.main()
