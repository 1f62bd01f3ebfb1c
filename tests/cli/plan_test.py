# SPDX-License-Identifier: GPL-3.0-or-later
"""The verbs that plan paths: dendrite and stylize (RELIABILITY rows 32 to 34, 71, 72)."""
import json
import os
import pathlib
import unittest

import numpy
from PIL import Image
from skimage.graph import MCP, MCP_Geometric

from harness import CliTest, png


def tiff(path, values):
    Image.fromarray(values.astype("float32"), mode="F").save(path)
    return path


def nodes(path):
    return json.loads(pathlib.Path(path).read_text())["nodes"]


class Plan(CliTest):
    def test_costs_are_scikit_images(self):
        rng = numpy.random.default_rng(5)
        weights = rng.uniform(0.5, 9.0, (40, 60))
        weights[10:14, 8:50] = 0  # a wall
        path = tiff(self.path("w.tiff"), weights)
        walled = numpy.where(weights > 0, weights, -1)
        for neighbours, cost, diagonal in [("8", "mean", "geometric"), ("4", "mean", "geometric"), ("4", "target", "none"), ("8", "target", "none")]:
            self.ok("dendrite", "--node-weights", path, "--connectivity", neighbours, "--edge-cost", cost, "--diagonal", diagonal,
                    "--roots", "30,30", "--count-endpoints", 20, "--debug-dir", self.path("debug"), "-o", self.path("d.json"))
            found = numpy.asarray(Image.open(self.path("debug/cost.tiff")))
            kind = MCP_Geometric if cost == "mean" else MCP
            expected, _ = kind(walled, fully_connected=neighbours == "8").find_costs([(30, 30)])
            reached = numpy.isfinite(expected)
            self.assertTrue((found[~reached] == -1).all())
            numpy.testing.assert_allclose(found[reached], expected[reached], rtol=1e-5)
            numpy.testing.assert_allclose(numpy.asarray(Image.open(self.path("debug/weights.tiff")))[weights > 0], weights[weights > 0], rtol=1e-6)

    def test_endpoints_from_table_and_picture(self):
        points = [(5, 6), (50, 8), (33, 41)]
        table = self.path("ends.csv", "x,y\n" + "\n".join(f"{x}, {y}" for x, y in points) + "\n\n# the end\n")
        dots = self.path("dots.png", png(64, 48, lambda x, y: (255, 255, 255) if (x, y) in points else (0, 0, 0)))
        for given in (table, dots):
            out = self.path("d.json")
            self.ok("dendrite", "--size", "64x48", "--endpoints", given, "-o", out)
            parents = {n[4] for n in nodes(out)}
            tips = {(n[0], n[1]) for i, n in enumerate(nodes(out)) if i not in parents}
            self.assertEqual(tips, set(map(tuple, points)))

    def test_mask_keeps_paths_inside_and_every_piece_has_a_root(self):
        def inside(x, y):
            return 4 <= y < 40 and (4 <= x < 24 or 40 <= x < 60)
        mask = self.path("mask.png", png(64, 48, lambda x, y: (255, 255, 255) if inside(x, y) else (0, 0, 0)))
        out = self.path("d.json")
        self.ok("dendrite", "--mask", mask, "--count-endpoints", 40, "-o", out)
        found = nodes(out)
        self.assertTrue(all(inside(n[0], n[1]) for n in found))
        self.assertEqual(sum(n[4] in (-1, None) for n in found), 2)

    def test_same_bytes_for_any_number_of_threads(self):
        photo = self.path("p.png", png(90, 70, lambda x, y: ((x * 7 + y * 3) % 256, (x * y) % 256, 90)))
        for verb in (["dendrite", "--preset", "fine", "--size", "120x120"], ["stylize", photo, "--count-endpoints", "200", "--scale", "1"],
                     ["stylize", photo, "--preset", "hidden", "--twigs", "200", "--scale", "1"]):
            digests = set()
            for threads in (1, 2, 5):
                self.ok(*verb, "--threads", threads, "-o", self.path("t.json"))
                digests.add(self.digest(self.path("t.json")))
            self.assertEqual(len(digests), 1)
            self.ok(*verb, "--seed", 2, "-o", self.path("u.json"))
            self.assertNotIn(self.digest(self.path("u.json")), digests)

    def test_presets(self):
        for verb in ("dendrite", "stylize"):
            listed = json.loads(self.ok(verb, *([self.photo] if verb == "stylize" else []), "--preset", "list", "--json").stdout)
            self.assertGreaterEqual(len(listed), 8)
        for preset in ("simple", "lightning", "moss", "winding"):
            self.ok("dendrite", "--preset", preset, "--size", "96x96", "-o", self.path(preset + ".swc"))
            self.assertTrue(os.path.exists(self.path(preset + ".swc")))
        self.fails(2, "did you mean fractal?", "dendrite", "--preset", "fractl", "-o", "a.json")

    def test_letters_are_filled_one_by_one(self):
        out = self.path("hi.json")
        self.ok("dendrite", "--text", "Hi\u00df", "--text-size", 120, "--count-endpoints", 200, "--refine", 1, "-o", out)
        roots = [n for n in nodes(out) if n[4] in (-1, None)]
        self.assertEqual(len(roots), 4)  # H, the stem and the dot of i, sharp s
        self.fails(2, "--mask", "dendrite", "--text", "a", "--mask", self.photo, "-o", "a.json")

    def test_lines_of_distance_and_cells(self):
        rng = numpy.random.default_rng(6)
        weights = rng.uniform(0.5, 3.0, (50, 70))
        path = tiff(self.path("w.tiff"), weights)
        roots = [(55, 12), (20, 25), (48, 40)]  # in reading order, as cells are numbered
        text = " ".join(f"{x},{y}" for x, y in roots)
        alone = [MCP_Geometric(weights, fully_connected=True).find_costs([(y, x)])[0] for x, y in roots]
        self.ok("dendrite", "--node-weights", path, "--roots", text, "--lines", "cells", "-o", self.path("cells.json"))
        cells = json.loads(pathlib.Path(self.path("cells.json")).read_text())
        own = numpy.argmin(alone, axis=0)
        away = 0
        for (x, y, *_), tag in zip(cells["nodes"], cells["tags"]):
            near = [(int(round(x)) + i, int(round(y)) + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
            labels = {int(own[j, i]) for i, j in near if 0 <= i < 70 and 0 <= j < 50}
            inside = 1 <= x <= 68 and 1 <= y <= 48
            away += tag - 1 not in labels or (inside and len(labels) < 2)
        self.assertEqual(away, 0)  # every outline lies where its cell ends
        self.assertEqual(set(cells["tags"]), {1, 2, 3})
        dots = self.path("ends.csv", "20,25\n")
        self.ok("dendrite", "--node-weights", path, "--roots", "20,25", "--endpoints", dots, "--lines", "distance", "--line-count", 4, "-o", self.path("far.json"))
        far = json.loads(pathlib.Path(self.path("far.json")).read_text())
        step = alone[1].max() / 5
        for (x, y, *_), tag in zip(far["nodes"], far["tags"]):
            low = alone[1][int(numpy.floor(y)):int(numpy.ceil(y)) + 1, int(numpy.floor(x)):int(numpy.ceil(x)) + 1]
            self.assertLessEqual(low.min(), tag * step * (1 + 1e-4))
            self.assertGreaterEqual(low.max(), tag * step * (1 - 1e-4))
        self.ok("dendrite", "--node-weights", path, "--lines", "distance", "-o", self.path("far.svg"))
        self.ok("dendrite", "--node-weights", path, "--lines", "distance", "-o", self.path("far.geojson"))
        self.fails(2, "--refine", "dendrite", "--lines", "distance", "--refine", 2, "-o", "a.json")
        self.fails(3, "several", "dendrite", "--size", "40x40", "--lines", "cells", "-o", "a.json")

    def test_walkers(self):
        self.ok("dendrite", "--walkers", 800, "--size", "101x101", "-o", self.path("w.json"))
        places = {(n[0], n[1]) for n in nodes(self.path("w.json"))}
        self.assertGreater(len(places), 500)
        self.assertTrue(all(any((x + i, y + j) in places for i, j in ((1, 0), (-1, 0), (0, 1), (0, -1))) for x, y in places))
        self.fails(2, "--walkers", "dendrite", "--walkers", 10, "--roots", "3,3", "-o", "a.json")
        self.fails(2, "--lines", "dendrite", "--walkers", 10, "--lines", "cells", "-o", "a.json")

    def test_moss_has_the_pictures_colours_and_replays(self):
        photo = self.path("p.png", png(96, 64, lambda x, y: (230, 30, 20) if x < 48 else (20, 60, 220)))
        out = self.path("moss.png")
        self.ok("moss", photo, "--height", 10, "--background", "#000000", "--threads", 1, "-o", out)
        found = numpy.asarray(Image.open(out).convert("RGB")).astype(int)
        left, right = found[20:60, 4:40].reshape(-1, 3), found[20:60, 56:92].reshape(-1, 3)
        self.assertTrue((left[:, 0] >= left[:, 2]).mean() > 0.99)
        self.assertTrue((right[:, 2] >= right[:, 0]).mean() > 0.99)
        self.assertGreater(left[:, 0].max(), 190)
        self.ok("moss", photo, "--height", 10, "--background", "#000000", "--threads", 2, "-o", self.path("two.png"))
        self.assertEqual(self.digest(out), self.digest(self.path("two.png")))
        self.ok("replay", out, "-o", self.path("again.png"))
        self.assertEqual(self.digest(out), self.digest(self.path("again.png")))
        self.ok("moss", photo, "--rows", 16, "--hairs", 0.05, "--background", "none", "-o", self.path("moss.svg"))
        self.fails(2, "transparency", "moss", photo, "--background", "none", "-o", "a.jpg")
        self.fails(3, "nowhere.png", "moss", "nowhere.png", "-o", "a.png")
        self.fails(2, "--height", "moss", photo, "--height", 0, "-o", "a.png")

    def test_blocked_start_and_no_way(self):
        def wall(x, y):
            return (0, 0, 0) if x == 30 else (255, 255, 255)
        mask = self.path("wall.png", png(60, 40, wall))
        ends = self.path("ends.csv", "50,20\n")
        out = ("-o", "a.json")
        os.mkdir(self.path("debug"))
        self.fails(2, "no path may run", "dendrite", "--mask", mask, "--roots", "30,20", *out)
        self.fails(3, "none can be reached", "dendrite", "--mask", mask, "--roots", "10,20", "--endpoints", ends, "--debug-dir", self.path("debug"), *out)
        reach = numpy.asarray(Image.open(self.path("debug/cost.tiff")))  # the picture of what is blocked
        self.assertTrue((reach[:, 30:] == -1).all() and (reach[:, :30] >= 0).all())
        nothing = tiff(self.path("nothing.tiff"), numpy.zeros((20, 20)))
        self.fails(3, "no node", "dendrite", "--node-weights", nothing, *out)
        bad = tiff(self.path("bad.tiff"), numpy.full((20, 20), numpy.nan))
        self.fails(3, "no node", "dendrite", "--node-weights", bad, *out)

    def test_layers_share_their_trunk(self):
        self.ok("stylize", "--preset", "tree", "--size", "200x240", "--layers", 2, "--twigs", 40, "--rounds", 2, "-o", self.path("t.json"))
        one, two = nodes(self.path("t_0000.json")), nodes(self.path("t_0001.json"))
        a, b = {(n[0], n[1]) for n in one}, {(n[0], n[1]) for n in two}
        self.assertGreater(len(a & b), 100)
        self.assertGreater(len(a - b), 50)

    def test_wrong_input_is_refused_in_one_sentence(self):
        out = ("-o", "a.json")
        self.path("bad.csv", "x,y\n1,2\nseven,3\n")
        self.path("empty.csv", "# nothing\n")
        self.path("black.png", png(32, 32, lambda x, y: (0, 0, 0)))
        self.path("grey.png", png(32, 32))
        self.path("dark.png", png(32, 32, lambda x, y: (0, 0, 0)))
        self.fails(3, "bad.csv:3", "dendrite", "--endpoints", "bad.csv", *out)
        self.fails(3, "no point", "dendrite", "--endpoints", "empty.csv", *out)
        self.fails(3, "none.csv", "dendrite", "--endpoints", "none.csv", *out)
        self.fails(3, "white dot", "dendrite", "--endpoints", "black.png", *out)
        self.fails(3, "black.png", "dendrite", "--mask", "black.png", *out)
        self.fails(2, "outside the canvas", "dendrite", "--size", "64x64", "--roots", "64,3", *out)
        self.fails(2, "--generator", "dendrite", "--roots", "3,3", "--generator", "black.png", *out)
        self.fails(3, "generator", "dendrite", "--generator", "black.png", *out)
        self.fails(2, "--attenuation", "dendrite", "--attenuation", "1", *out)
        self.fails(5, "--limit-pixels", "dendrite", "--size", "40000x40000", *out)
        self.fails(5, "bytes", "dendrite", "--size", "1000000x1000000", *out)
        self.fails(5, "bytes", "stylize", "--preset", "tree", "--size", "1000000x1000000", *out)
        self.fails(5, "--limit-pixels", "stylize", "grey.png", "--scale", "100", "--limit-pixels", "1e5", *out)
        self.fails(3, "no pixel that paths may use", "stylize", "grey.png", "--mask", "dark.png", *out)
        self.fails(2, "--size", "dendrite", "--size", "64", *out)
        for count in ("0", "-1", "9223372036854775808", "many", "1e30", "nan"):
            self.fails(2, "--count-endpoints", "dendrite", "--count-endpoints", count, *out)
        self.fails(2, "--count-endpoints", "dendrite", "--cuont-endpoints", "5", *out)
        self.fails(2, ".json", "dendrite", "-o", "a.png")
        self.fails(2, "--output", "dendrite")
        self.fails(2, "--tree", "stylize", *out)
        self.fails(2, "--layers", "stylize", "grey.png", "--layers", "2", *out)
        self.fails(3, "nowhere.png", "stylize", "nowhere.png", *out)
        self.fails(3, "same", "stylize", self.photo, "--mask", "black.png", *out)
        self.fails(2, "one point", "stylize", "grey.png", "--root", "1,1 2,2", *out)


if __name__ == "__main__":
    unittest.main()
