# SPDX-License-Identifier: GPL-3.0-or-later
"""figure: shapes and texts that become trees (RELIABILITY rows 33, 34, 71, 72)."""
import json
import os
import pathlib
import unittest
import xml.etree.ElementTree as ET

import numpy
from PIL import Image, ImageDraw
from scipy import ndimage

from harness import CliTest

SVG = "{http://www.w3.org/2000/svg}"


class Figure(CliTest):
    def shape(self, name="shape.png", mode="L"):
        """A black ring with a stem, and a block apart."""
        y, x = numpy.mgrid[:140, :180]
        ring = (numpy.hypot(x - 60, y - 60) < 48) & (numpy.hypot(x - 60, y - 60) > 22)
        shape = ring | ((abs(x - 60) < 4) & (y > 60) & (y < 130)) | ((x > 130) & (x < 165) & (y > 40) & (y < 110))
        Image.fromarray(numpy.where(shape, 0, 255).astype("uint8")).convert(mode).save(self.path(name))
        return self.path(name), shape

    def test_a_bitmap_is_filled_and_not_left(self):
        path, shape = self.shape()
        self.ok("figure", path, "-o", self.path("a.png"), "--points", "300")
        alpha = numpy.asarray(Image.open(self.path("a.png")))[..., 3]
        near = ndimage.binary_dilation(shape, numpy.ones((3, 3)))
        self.assertEqual(int((alpha[~near] > 3).sum()), 0)
        within = ndimage.distance_transform_edt(alpha < 100)
        self.assertGreater((within[shape] < 9).mean(), 0.95)  # no corner stays empty
        self.ok("figure", self.shape("rgba.png", "RGBA")[0], "-o", self.path("b.png"), "--points", "300")
        self.assertEqual(alpha.tolist(), numpy.asarray(Image.open(self.path("b.png")))[..., 3].tolist())

    def test_the_skeleton_is_one_tree_an_island_or_one_over_bridges(self):
        path, _ = self.shape()
        for join, roots in (("apart", 2), ("bridges", 1)):
            self.ok("figure", path, "-o", self.path("a.json"), "--join", join)
            nodes = json.loads(pathlib.Path(self.path("a.json")).read_text())["nodes"]
            self.assertEqual(sum(node[4] is None or node[4] < 0 for node in nodes), roots)

    def test_text_in_any_script(self):
        for text in ("Äpfel", "Ωmega", "Лес", "A\\nB"):
            self.ok("figure", "--text", text, "-o", self.path("a.png"), "--text-size", "80")
            self.assertGreater(numpy.asarray(Image.open(self.path("a.png")))[..., 3].mean(), 2)
        self.ok("figure", "--text", "AB", "-o", self.path("b.png"), "--text-size", "80")
        with Image.open(self.path("a.png")) as below, Image.open(self.path("b.png")) as beside:
            self.assertGreater(below.size[1], 1.5 * beside.size[1])
            self.assertLess(below.size[0], beside.size[0])

    def test_the_letters_are_those_pillow_draws(self):
        from PIL import ImageFont
        font = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"
        self.ok("figure", "--text", "Rag", "--font", font, "--text-size", "120", "-o", self.path("a.json"), "--debug-dir", self.path("d"))
        ours = numpy.asarray(Image.open(self.path("d/region.png"))) > 0
        page = Image.new("L", (ours.shape[1], ours.shape[0]))
        ImageDraw.Draw(page).text((20, 0), "Rag", 255, ImageFont.truetype(font, 120))
        theirs = numpy.asarray(page) > 127
        def cropped(mask):
            rows, columns = numpy.where(mask.any(1))[0], numpy.where(mask.any(0))[0]
            return mask[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1]
        a, b = cropped(ours), cropped(theirs)
        self.assertLessEqual(max(abs(a.shape[0] - b.shape[0]), abs(a.shape[1] - b.shape[1])), 3)
        self.assertLess(abs(a.sum() / b.sum() - 1), 0.02)

    def test_every_drawing_of_paint_and_same_bytes(self):
        path, _ = self.shape()
        for name, extra in (("a.svg", ["--preset", "ivy"]), ("a.png", ["--preset", "blossom", "--scale", "2"]), ("a.webp", ["--animate", "--frames", "3"])):
            made = set()
            for threads in (1, 2, 8):
                self.ok("figure", path, "-o", self.path(name), "--seed", "3", "--threads", threads, *extra)
                made.add(self.digest(self.path(name)))
            self.ok("replay", self.path(name), "-o", self.path("again" + name[1:]))
            made.add(self.digest(self.path("again" + name[1:])))
            self.assertEqual(len(made), 1, name)
        ET.parse(self.path("a.svg"))
        for points in ["0", "2000"]:  # many twigs are thinner than other drawings' lines may be
            self.ok("figure", "--text", "so", "--text-size", "60", "--points", points, "-o", self.path("t.svg"))
            self.ok("replay", self.path("t.svg"), "-o", self.path("u.svg"))
            self.assertEqual(self.digest(self.path("t.svg")), self.digest(self.path("u.svg")))

    def test_200_mazes_are_reached_wholly_and_not_left(self):
        """On one sheet, drawn by Pillow at eight times the size; corridors one pixel wide, rings, several parts."""
        rng = numpy.random.default_rng(7)
        side, columns, gap, fine = 56, 20, 4, 8
        sheet = numpy.zeros((10 * (side + gap), columns * (side + gap)), bool)
        for number in range(200):
            maze = numpy.zeros((side, side), bool)
            y, x = numpy.mgrid[:side, :side]
            for _ in range(rng.integers(1, 5)):
                distance = numpy.hypot((x - rng.integers(side)) / rng.uniform(3, 14), (y - rng.integers(side)) / rng.uniform(3, 14))
                maze |= (distance <= 1) & (distance >= rng.choice([0, 0.6]))
            for _ in range(rng.integers(2, 8)):
                (ax, ay), (bx, by) = rng.integers(side, size=(2, 2))
                maze[ay, min(ax, bx):max(ax, bx) + 1] = True
                maze[min(ay, by):max(ay, by) + 1, bx] = True
            top, left = number // columns * (side + gap), number % columns * (side + gap)
            sheet[top:top + side, left:left + side] = maze
        parts, count = ndimage.label(sheet)
        sheet &= numpy.bincount(parts.ravel())[parts] >= 3  # smaller ones are left out, with a note
        parts, count = ndimage.label(sheet)
        self.assertGreater(count, 200)
        path = self.path("mazes.png")
        Image.fromarray(numpy.where(sheet, 0, 255).astype("uint8")).save(path)
        away = ndimage.distance_transform_edt(~numpy.kron(sheet, numpy.ones((fine, fine), bool)))
        for extra in ([], ["--lines", "straight", "--tree", "random"]):
            self.ok("figure", path, "-o", self.path("m.json"), "--points", "9000", "--debug-dir", self.path("d"), *extra)
            sites = numpy.loadtxt(self.path("d/sites.csv"), delimiter=",", skiprows=1)
            parents = sites[:, 2].astype(int)
            part_of = parts[sites[:, 1].round().astype(int), sites[:, 0].round().astype(int)]
            self.assertEqual(sorted(part_of[parents < 0]), list(range(1, count + 1)))  # one root in every part
            self.assertTrue((part_of[parents >= 0] == part_of[parents[parents >= 0]]).all())
            reached, before = parents < 0, 0
            while reached.sum() > before:
                before = reached.sum()
                reached |= (parents >= 0) & reached[parents]
            self.assertTrue(reached.all())
            drawn = self.drawn(json.loads(pathlib.Path(self.path("m.json")).read_text())["nodes"], sheet.shape, fine)
            self.assertLessEqual(away[drawn].max(), fine + 0.5)  # 1 px
            self.assertGreater(drawn.sum(), 0.1 * fine * fine * sheet.sum())

    @staticmethod
    def drawn(nodes, shape, fine):
        """A skeleton as discs and the trapezia between them."""
        page = Image.new("1", (shape[1] * fine, shape[0] * fine))
        pen = ImageDraw.Draw(page)
        places = [((x + 0.5) * fine, (y + 0.5) * fine, r * fine) for x, y, _, r, _ in nodes]
        for (x, y, r), node in zip(places, nodes):
            pen.ellipse((x - r, y - r, x + r, y + r), fill=1)
            px, py, pr = places[node[4]] if node[4] >= 0 else (x, y, r)
            length = numpy.hypot(x - px, y - py)
            if length > 0:
                nx, ny = (y - py) / length, (px - x) / length
                pen.polygon([(x + nx * r, y + ny * r), (px + nx * pr, py + ny * pr), (px - nx * pr, py - ny * pr), (x - nx * r, y - ny * r)], fill=1)
        return numpy.asarray(page)

    def test_intermediates(self):
        path, _ = self.shape()
        self.ok("figure", path, "-o", self.path("a.svg"), "--debug-dir", self.path("d"))
        self.assertEqual(sorted(os.listdir(self.path("d"))), ["cells.png", "painting.svg", "region.png", "sites.csv", "skeleton.json"])

    def test_what_cannot_be_filled(self):
        white, dot = self.path("w.png"), self.path("dot.png")
        Image.new("L", (40, 30), 255).save(white)
        picture = Image.new("L", (40, 30), 255)
        picture.putpixel((5, 5), 0)
        picture.save(dot)
        out = self.path("o.png")
        self.fails(3, "empty", "figure", white, "-o", out)
        self.ok("figure", white, "--invert", "-o", out)
        os.remove(out)
        self.fails(3, "smaller than 3 px", "figure", dot, "-o", out)
        many = Image.new("L", (640, 512), 255)  # 500 parts: 100 of one pixel, 400 squares, of these 200 with a hole
        draw = ImageDraw.Draw(many)
        for i in range(500):
            x, y = 5 + 25 * (i % 25), 5 + 25 * (i // 25)
            draw.rectangle((x, y, x, y) if i % 5 == 0 else (x, y, x + 13, y + 13), fill=0)
            if i % 5 in (1, 3):
                draw.rectangle((x + 4, y + 4, x + 9, y + 9), fill=255)
        many.save(self.path("many.png"))
        done = self.ok("figure", self.path("many.png"), "--points", "3000", "-o", self.path("many.json"))
        self.assertIn("100 parts of the shape smaller than 3 px are left out, 400 are filled", done.stderr)
        tree = json.loads(pathlib.Path(self.path("many.json")).read_text())["nodes"]
        self.assertEqual(sum(node[4] is None or node[4] < 0 for node in tree), 400)
        near = ndimage.binary_dilation(numpy.asarray(many) == 0, numpy.ones((3, 3)))
        self.assertTrue(all(near[round(node[1]), round(node[0])] for node in tree))  # holes stay empty
        self.fails(3, "font", "figure", "--text", "a", "--font", "No Such Font At All", "-o", out)
        self.fails(3, "U+", "figure", "--text", "\U0001F9FF", "-o", out)
        self.fails(2, "empty", "figure", "--text", " ", "-o", out)
        self.fails(2, "", "figure", "-o", out)
        self.fails(5, "MiB", "figure", "--text", "wide", "--text-size", "9000", "-o", out, "--limit-pixels", "1e6")
        self.fails(5, ["lines", "--text-size"], "figure", "--text", "w" * 500, "-o", self.path("long.svg"))

    def test_options_without_effect_are_refused(self):
        path, _ = self.shape()
        out = self.path("o.png")
        for extra in (["--text", "x"], ["--font", "DejaVu Sans"], ["--baseline"], ["--border-points", "9"], ["--bridge", "3"],
                      ["--lines", "straight", "--curl", "0.5"], ["--leaf", "oak"]):
            self.fails(2, "no effect", "figure", path, "-o", out, *extra)
        self.fails(2, "no effect", "figure", "--text", "x", "--invert", "-o", out)
        self.fails(2, "no effect", "figure", path, "-o", self.path("o.json"), "--palette", "gold")
        self.fails(2, "start", "figure", path, "-o", out, "--start", "middle")
        self.fails(2, "", "figure", path, "-o", out, "--points", "-3")


if __name__ == "__main__":
    unittest.main()
