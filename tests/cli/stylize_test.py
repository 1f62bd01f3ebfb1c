# SPDX-License-Identifier: GPL-3.0-or-later
"""stylize: what it leaves in --debug-dir against scikit-image, the same ends for every metric, bad values."""
import json
import os
import pathlib
import unittest

import numpy
from PIL import Image
from skimage.graph import MCP_Geometric

from harness import CliTest


def stripes(path):
    """Light ground with dark waves, 120 x 90."""
    y, x = numpy.mgrid[0:90, 0:120]
    grey = numpy.full((90, 120), 235.0)
    for middle in (20, 45, 70):
        grey = numpy.minimum(grey, 20 + 60 * numpy.abs(y - middle - 8 * numpy.sin(x / 9.0)))
    Image.fromarray(grey.clip(0, 235).astype("uint8")).save(path)
    return path


def table(path):
    return numpy.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)


def tiff(path):
    return numpy.asarray(Image.open(path), float)


class Stylize(CliTest):
    def test_intermediates_are_what_they_say(self):
        photo, debug = stripes(self.path("p.png")), pathlib.Path(self.path("debug"))
        self.ok("stylize", photo, "--scale", "1", "--metric", "sum", "--count-endpoints", "200", "--debug-dir", debug, "-o", self.path("s.json"))
        self.assertEqual(sorted(os.listdir(debug)), ["contours.png", "cost.tiff", "drawn_0.png", "endpoints.csv", "importance.tiff",
                                                     "seed_0.png", "stipple_cost.tiff", "weights.tiff"])
        ends, cost = table(debug / "endpoints.csv"), tiff(debug / "cost.tiff")
        self.assertAlmostEqual(len(ends) / 200, 1.0, delta=0.03)
        root = numpy.unravel_index(cost.argmin(), cost.shape)
        expected, _ = MCP_Geometric(tiff(debug / "weights.tiff"), fully_connected=True).find_costs([root])
        numpy.testing.assert_allclose(cost, expected, rtol=1e-5)
        # Brighter = reached earlier. Lines and the seed's dot aside, which cover less than half, the order is the costs'.
        light = numpy.asarray(Image.open(debug / "contours.png").convert("L"), float)
        order = cost.ravel().argsort().argsort() / cost.size
        plain = numpy.abs(light.ravel() - 255 * (1 - 0.8 * order)) < 2
        self.assertGreater(plain.mean(), 0.5)
        stipple = tiff(debug / "stipple_cost.tiff")
        for x, y in ends.astype(int):
            self.assertEqual(stipple[y, x], 0)
        self.assertEqual(int((stipple == 0).sum()), len(ends) + 1)
        importance = tiff(debug / "importance.tiff")
        self.assertTrue(0 <= importance.min() and importance.max() <= 1)
        self.assertGreater(importance[root], numpy.quantile(importance, 0.6))  # the seed is on a main line
        drawn = numpy.asarray(Image.open(debug / "drawn_0.png").convert("L")) < 128
        for node in json.loads(pathlib.Path(self.path("s.json")).read_text())["nodes"]:
            self.assertTrue(drawn[round(node[1]), round(node[0])])

    def test_what_is_transparent_is_empty(self):
        lines = {}
        for ground in [0, 255]:  # what lies under the transparency
            pixels = numpy.full((90, 120, 4), ground, "uint8")
            pixels[..., 3] = 0
            pixels[20:70, 30:90] = [40, 40, 40, 255]
            Image.fromarray(pixels).save(self.path("cut_out.png"))
            self.ok("stylize", self.path("cut_out.png"), "--scale", "1", "--count-endpoints", "200", "-o", self.path("s.json"))
            lines[ground] = self.digest(self.path("s.json"))
        self.assertEqual(lines[0], lines[255])

    def test_every_metric_gets_the_same_ends(self):
        photo, seen = stripes(self.path("p.png")), set()
        for metric in ("sum", "partial", "full", "power", "mix"):
            debug = pathlib.Path(self.path("debug_" + metric))
            self.ok("stylize", photo, "--scale", "1", "--metric", metric, "--count-endpoints", "150", "--debug-dir", debug, "-o", self.path("s.json"))
            seen.add((debug / "endpoints.csv").read_bytes() + (debug / "weights.tiff").read_bytes())
        self.assertEqual(len(seen), 1)

    def test_a_round_starts_from_what_the_rounds_before_drew(self):
        debug = pathlib.Path(self.path("debug"))
        self.ok("stylize", "--preset", "tree", "--size", "160x200", "--twigs", "30", "--rounds", "3", "--debug-dir", debug, "-o", self.path("t.json"))
        for before, after in ((0, 1), (1, 2)):
            drawn = numpy.asarray(Image.open(debug / f"drawn_{before}.png").convert("RGB"), int)
            seed = numpy.asarray(Image.open(debug / f"seed_{after}.png").convert("RGB"), int)
            black, green, red = drawn.sum(axis=2) < 200, seed[..., 1] > seed[..., 0] + 50, seed[..., 0] > seed[..., 1] + 50
            self.assertTrue((black == (green | (black & red))).all())  # green where the earlier rounds drew, or under a red dot
            self.assertGreater(red.sum(), 20)
        self.assertFalse((debug / "drawn_3.png").exists())

    def test_crowns_leave_the_corners_free(self):
        self.ok("stylize", "--preset", "tree", "--size", "200x240", "--twigs", "80", "-o", self.path("t.json"))
        nodes = json.loads(pathlib.Path(self.path("t.json")).read_text())["nodes"]
        parents = {node[4] for node in nodes}
        tips = [(node[0], node[1]) for i, node in enumerate(nodes) if i not in parents]
        self.assertGreater(len(tips), 100)
        for x, y in tips:
            self.assertFalse(min(x, 199 - x) < 15 and y < 20, (x, y))

    def test_values_out_of_range_are_refused(self):
        photo = stripes(self.path("p.png"))
        for name, value in (("count-endpoints", "0"), ("constant", "0"), ("noise", "-1"), ("noise", "nan"), ("least-importance", "2"), ("upward", "0"),
                            ("sideways", "-1"), ("thin", "0"), ("thick", "inf"), ("window", "-1"), ("edges", "-1"), ("edge-blur", "99"), ("scale", "-1"),
                            ("layers", "0"), ("rounds", "0"), ("limbs", "-1"), ("trunk", "2"), ("twigs", "0"), ("branching", "0.5"), ("reach", "0"),
                            ("shrink", "2"), ("roughness", "-1"), ("gnarl", "-1"), ("hidden", "2"), ("hops", "0"), ("random-share", "-1"),
                            ("metric", "maximum"), ("thickness", "fat"), ("power", "0.5"), ("seed", "-1"), ("preset", "non")):
            self.fails(2, "--" + name, "stylize", photo, "--" + name, value, "-o", self.path("s.json"))
        self.assertFalse(os.path.exists(self.path("s.json")))
        self.fails(3, "least-importance", "stylize", photo, "--least-importance", "1", "-o", self.path("s.json"))
        self.fails(2, "outside the picture of 120x90 px", "stylize", photo, "--root", "500,3", "-o", self.path("s.json"))


if __name__ == "__main__":
    unittest.main()
