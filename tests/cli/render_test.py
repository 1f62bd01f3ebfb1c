# SPDX-License-Identifier: GPL-3.0-or-later
"""render: any skeleton with any photo. Widths by quantiles against numpy, scale, bends with ends held."""
import json
import pathlib
import unittest

import numpy
from PIL import Image
from scipy import ndimage

from harness import CliTest


class Render(CliTest):
    def skeleton(self, name="s.json", factor=1.0, radius=lambda i: 4.0 + 0.5 * (i % 7)):
        """Two arches and a twig on 200 x 150 px, all lengths times `factor`."""
        nodes = []
        for arch, y in ((0, 60), (1, 110)):
            first = len(nodes)
            for i in range(61):
                x = 10 + 3 * i
                nodes.append([x, y - 30 * numpy.sin(numpy.pi * i / 60), radius(i + 61 * arch), -1 if i == 0 else first + i - 1])
        for i in range(8):
            nodes.append([100 + 3 * i, 30 - 2 * i if i else 30, radius(i), 30 if i == 0 else len(nodes) - 1])
        rows = [f"{i + 1} 0 {x * factor} {y * factor} 0 {r * factor} {p + 1 if p >= 0 else -1}" for i, (x, y, r, p) in enumerate(nodes)]
        return self.path(name.replace(".json", ".swc"), "\n".join(rows) + "\n")

    def swc(self, path):
        rows = [line.split() for line in pathlib.Path(path).read_text().splitlines() if line and not line.startswith("#")]
        return numpy.array(rows, float)

    def spread(self, rows):
        """Radii and mid-rank shares, every node with half the length of its edges, by numpy."""
        index = {int(row[0]): k for k, row in enumerate(rows)}
        weight = numpy.zeros(len(rows))
        for k, row in enumerate(rows):
            if row[6] > 0:
                other = index[int(row[6])]
                half = numpy.hypot(*(rows[k, 2:4] - rows[other, 2:4])) / 2
                weight[k] += half
                weight[other] += half
        radii, group = numpy.unique(rows[:, 5], return_inverse=True)
        own = numpy.bincount(group, weight)
        keep = own > 0
        return radii[keep], (numpy.cumsum(own) - own / 2)[keep] / own.sum()

    def test_widths_are_mapped_as_numpy_does(self):
        out, fitted, folder = self.path("o.png"), self.path("f.swc"), self.path("d")
        source = self.skeleton()
        self.ok("render", self.exemplar, source, "-o", out, "--size", "200x150", "--radii", "map", "--scale", "1", "--fitted", fitted, "--debug-dir", folder)
        theirs, given, mapped = self.swc(f"{folder}/exemplar_skeleton.swc"), self.swc(source), self.swc(fitted)
        own, wanted = self.spread(given), self.spread(theirs)
        expected = numpy.interp(numpy.interp(given[:, 5], *own), wanted[1], wanted[0])
        numpy.testing.assert_allclose(mapped[:, 5], expected, rtol=1e-4)
        numpy.testing.assert_allclose(mapped[:, 2:4], given[:, 2:4], atol=1e-6)
        self.ok("render", self.exemplar, source, "-o", out, "--size", "200x150", "--radii", "keep", "--fitted", fitted)
        numpy.testing.assert_allclose(self.swc(fitted)[:, 5], given[:, 5], rtol=1e-6)

    def test_scale_is_chosen_between_one_and_two(self):
        own = numpy.median(numpy.repeat(*self.lengths()))
        for factor, expected in ((8, 2.0), (1.6, 1.6), (1.1, 1.0), (0.2, 1.0)):
            source = self.skeleton(radius=lambda i: own / factor)
            out, fitted = self.path("o.png"), self.path("f.swc")
            done = self.ok("render", self.exemplar, source, "-o", out, "--fitted", fitted, "--radii", "keep", "--verbose")
            before, after = self.swc(source), self.swc(fitted)
            ratio = numpy.ptp(after[:, 2]) / numpy.ptp(before[:, 2])
            self.assertAlmostEqual(ratio, expected, delta=0.12 * expected)
            self.assertEqual("--scale" in done.stderr, expected > 1)
        self.ok("render", self.exemplar, self.skeleton(), "-o", out, "--size", "200x150", "--scale", "1.5", "--fitted", fitted)
        self.assertAlmostEqual(numpy.ptp(self.swc(fitted)[:, 2]), 1.5 * numpy.ptp(self.swc(self.skeleton())[:, 2]), delta=1e-3)
        with Image.open(out) as picture:
            self.assertEqual(picture.size, (200, 150))

    def lengths(self):
        """The exemplar's radii, and how often each counts."""
        self.ok("convert", self.exemplar, "-o", self.path("e.swc"))
        radii, shares = self.spread(self.swc(self.path("e.swc")))
        return radii, numpy.maximum(1, numpy.round(1000 * numpy.gradient(shares))).astype(int)

    def test_its_own_grown_skeletons_are_left_alone(self):
        self.ok("grow", self.exemplar, "-o", self.path("g.swc"), "--seed", "3")
        self.ok("render", self.exemplar, self.path("g.swc"), "-o", self.path("o.png"), "--fitted", self.path("f.swc"), "--size", "240x180")
        numpy.testing.assert_allclose(self.swc(self.path("f.swc"))[:, 2:6], self.swc(self.path("g.swc"))[:, 2:6], atol=1e-6)

    def test_restyled_bends_keep_their_ends_and_replay_gives_the_same_bytes(self):
        out, fitted = self.path("o.png"), self.path("f.swc")
        args = ["render", self.exemplar, self.skeleton(), "-o", out, "--size", "200x150", "--scale", "1", "--fitted", fitted, "--seed", "4"]
        moved = []
        for strength in ("0", "0.5", "1"):
            self.ok(*args, "--restyle", strength)
            before, after = self.swc(self.skeleton()), self.swc(fitted)
            for rows in (before, after):
                self.assertEqual(len(set(rows[:, 0])), len(rows))
            ends = lambda rows: sorted(map(tuple, numpy.round([r[2:4] for r in rows if r[0] not in set(rows[:, 6]) or r[6] < 0], 5)))
            numpy.testing.assert_allclose(ends(after), ends(before), atol=2e-5)
            near = numpy.hypot(*(after[:, None, 2:4] - before[None, :, 2:4]).transpose(2, 0, 1)).min(1)
            moved.append(near.max())
        self.assertEqual(moved[0], 0)
        self.assertGreater(moved[2], moved[1])
        self.ok("replay", out, "-o", self.path("again.png"), "--inputs", self.small)
        self.assertEqual(self.digest(out), self.digest(self.path("again.png")))
        made = set()
        for threads in (1, 2, 8):
            self.ok(*args, "--restyle", "0.7", "--threads", threads)
            made.add(self.digest(out))
        self.assertEqual(len(made), 1)

    def test_what_cannot_be_fitted(self):
        source, out = self.skeleton(), self.path("o.png")
        self.fails(2, "scale", "render", self.exemplar, source, "-o", out, "--scale", "0.2")
        self.fails(2, "scale", "render", self.exemplar, source, "-o", out, "--scale", "3")
        self.fails(2, "restyle", "render", self.exemplar, source, "-o", out, "--restyle", "1.5")
        self.fails(2, "radii", "render", self.exemplar, source, "-o", out, "--radii", "some")
        self.fails(2, "thickness", "render", self.exemplar, source, "-o", out, "--thickness", "nan")
        self.fails(3, "", "render", self.exemplar, self.path("none.swc", "# nothing\n"), "-o", out)
        self.fails(5, "", "render", self.exemplar, self.skeleton("big.json", 40.0), "-o", out, "--scale", "2", "--limit-pixels", "1e6")
        self.assertFalse(pathlib.Path(out).exists())

    def test_masks_are_those_of_what_is_drawn(self):
        """A root of 60 px is more than the photo's river has: the picture gets the photo's widths, and so must the mask."""
        self.ok("synth", "builtin:river", "--size", "480x320", "--roots", "0,160,0,60", "-o", self.path("o.png"), "--mask", self.path("m.png"))
        color = numpy.asarray(Image.open(self.path("o.png")).convert("RGB")).astype(int)
        water = ndimage.binary_opening(color[..., 0] - color[..., 1] > 12)
        inside = numpy.asarray(Image.open(self.path("m.png"))) >= 128
        well_inside, well_outside = ndimage.binary_erosion(inside, iterations=3), ~ndimage.binary_dilation(inside, iterations=3)
        self.assertGreater(well_inside.sum(), 3000)
        self.assertLess((well_inside & ~water).sum(), 0.01 * inside.sum())
        self.assertLess((well_outside & water).sum(), 0.01 * inside.sum())

    def test_hostile_numbers_end_with_an_error_or_a_picture(self):
        out = self.path("o.png")
        for row in ("1e300 5", "5 1e30", "-1e9 -1e9", "0 0"):
            bent = f"1 0 10 10 0 2 -1\n2 0 {row} 0 2 1\n3 0 60 40 0 2 2\n"
            done = self.run_cli("render", self.exemplar, self.path("h.swc", bent), "-o", out, "--size", "80x60", "--restyle", "1", timeout=60)
            self.assertIn(done.returncode, (0, 3, 5), done.stderr)


if __name__ == "__main__":
    unittest.main()
