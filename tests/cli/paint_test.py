# SPDX-License-Identifier: GPL-3.0-or-later
"""paint: drawings against other programs (librsvg, Pillow), same bytes, bad input (RELIABILITY rows 33, 34, 46, 71)."""
import io
import json
import os
import pathlib
import shutil
import subprocess
import unittest
import xml.etree.ElementTree as ET

import numpy
from PIL import Image

from harness import CliTest

INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
SVG = "{http://www.w3.org/2000/svg}"


def tree_swc():
    """A trunk with six branches on a 200 x 160 canvas."""
    rows = ["# ramify canvas 200 160"]
    rows += [f"{i + 1} 0 {100 + (i % 3) - 1} {155 - 7 * i} 0 {7 - 0.25 * i} {i if i else -1}" for i in range(20)]
    number = 21
    for b, side in enumerate((-1, 1, -1, 1, -1, 1)):
        parent, x, y = 4 + 2 * b, 100, 155 - 7 * (3 + 2 * b)
        for i in range(9):
            x, y = x + side * 8, y - 3 - (i % 2) * 2
            rows.append(f"{number} 0 {x} {y} 0 {2.4 - 0.2 * i} {parent}")
            parent, number = number, number + 1
    return "\n".join(rows) + "\n"


def rendered(svg):
    """Pixels of librsvg, straight alpha."""
    done = subprocess.run(["rsvg-convert", svg], capture_output=True, check=True)
    return numpy.asarray(Image.open(io.BytesIO(done.stdout)).convert("RGBA"), float) / 255


def over(pixels, paper):
    alpha = pixels[..., 3:]
    return pixels[..., :3] * alpha + paper * (1 - alpha)


class Paint(CliTest):
    def setUp(self):
        super().setUp()
        self.tree = self.path("tree.swc", tree_swc())

    def test_librsvg_sees_what_we_paint(self):
        for style, extra in (("ink", ["--palette", "coral"]), ("vine", ["--flowers", "0.4"]), ("vine", ["--leaf", "ivy", "--phyllotaxis", "spiral"]),
                             ("woodcut", ["--background", "#f4ecd8", "--hatching", "0"])):
            for scale in (1, 3):
                svg, png = self.path("a.svg"), self.path("a.png")
                common = ["--style", style, "--scale", scale, *extra]
                self.ok("paint", self.tree, "-o", svg, *common)
                self.ok("paint", self.tree, "-o", png, *common)
                ours = numpy.asarray(Image.open(png).convert("RGBA"), float) / 255
                theirs = rendered(svg)
                self.assertEqual(ours.shape, theirs.shape)
                self.assertEqual(ours.shape[:2], (160 * scale, 200 * scale))
                for paper in (1.0, 0.0):
                    difference = numpy.abs(over(ours, paper) - over(theirs, paper))
                    self.assertLess(difference.mean(), 0.003, (style, scale, paper))
                    self.assertLess((difference.max(axis=2) > 0.12).mean(), 0.004, (style, scale, paper))

    def test_light_in_svg_is_the_light_in_pixels_to_the_eye(self):
        svg, png = self.path("a.svg"), self.path("a.png")
        for preset in ("lightning", "ember", "aurora"):
            for background in ([], ["--background", "none"]):
                for out in (svg, png):
                    self.ok("paint", self.tree, "-o", out, "--preset", preset, *background)
                ours = over(numpy.asarray(Image.open(png).convert("RGBA"), float) / 255, 0.0)
                theirs = over(rendered(svg), 0.0)
                self.assertLess(numpy.abs(ours - theirs).mean(), 0.07, (preset, background))
                self.assertGreater(numpy.corrcoef(ours.mean(axis=2).ravel(), theirs.mean(axis=2).ravel())[0, 1], 0.97, (preset, background))

    @unittest.skipUnless(shutil.which("inkscape"), "Inkscape is not installed")
    def test_inkscape_opens_what_we_paint(self):
        svg, png = self.path("a.svg"), self.path("a.png")
        self.ok("paint", self.tree, "-o", svg, "--preset", "lightning")
        done = subprocess.run(["inkscape", svg, "--export-type=png", "-o", png], capture_output=True, check=True)
        theirs = numpy.asarray(Image.open(png).convert("RGB"), float) / 255
        self.assertLess(numpy.abs(theirs - over(rendered(svg), 0.0)).mean(), 0.03, done.stderr)

    def test_svg_has_inkscape_layers_and_few_nodes(self):
        svg = self.path("a.svg")
        self.ok("paint", self.tree, "-o", svg)
        root = ET.parse(svg).getroot()
        self.assertEqual(root.get("viewBox"), "0 0 200 160")
        layers = [g for g in root.iter(SVG + "g") if g.get(INKSCAPE + "groupmode") == "layer"]
        self.assertEqual([g.get(INKSCAPE + "label") for g in layers], ["order 1", "order 0"])
        paths = list(root.iter(SVG + "path"))
        self.assertEqual(len(paths), 7)
        self.assertLess(sum(p.get("d").count("c") for p in paths), 25 * len(paths))

    def test_opacity_depth_and_size(self):
        out = self.path("a.png")
        self.ok("paint", self.tree, "-o", out, "--size", "500x300", "--depth", "16")
        picture = Image.open(out)
        self.assertEqual(picture.size, (500, 300))
        data = pathlib.Path(out).read_bytes()
        self.assertEqual((data[24], data[25]), (16, 6))  # bits, RGB with alpha
        alpha = numpy.asarray(picture.convert("RGBA"))[..., 3]
        self.assertEqual((alpha[0, 0], alpha.max()), (0, 255))
        self.ok("paint", self.tree, "-o", self.path("b.png"), "--background", "#204060")
        plain = Image.open(self.path("b.png"))
        self.assertEqual(plain.mode, "RGB")
        self.assertEqual(plain.getpixel((0, 0)), (0x20, 0x40, 0x60))

    def test_painting_on_a_photo(self):
        photo = self.path("p.png")
        Image.new("RGB", (400, 320), (30, 60, 90)).save(photo)
        for style in ("ink", "lightning"):
            self.ok("paint", self.tree, "-o", self.path("o.png"), "--over", photo, "--style", style)
            picture = numpy.asarray(Image.open(self.path("o.png")))
            self.assertEqual(picture.shape, (320, 400, 3))
            self.assertLess(numpy.abs(picture[2, 2].astype(int) - (30, 60, 90)).max(), 2 if style == "ink" else 40)
            middle = picture[280, 200].astype(int)
            self.assertTrue((middle < (60, 60, 60)).all() if style == "ink" else (middle > 200).all(), middle)

    def test_a_drawing_stands_small_where_it_is_told(self):
        photo = self.path("p.png")
        Image.new("RGB", (300, 200), (200, 210, 220)).save(photo)
        self.ok("paint", self.tree, "-o", self.path("o.png"), "--over", photo, "--at", "220,150", "--scale", "0.25", "--smooth", "0")
        self.ok("paint", self.tree, "-o", self.path("alone.png"), "--smooth", "0")
        placed = numpy.asarray(Image.open(self.path("o.png")).convert("L"), float)
        self.assertEqual(placed.shape, (200, 300))
        ys, xs = numpy.nonzero(placed < 190)
        alone = numpy.asarray(Image.open(self.path("alone.png")))[..., 3] > 100
        ay, ax = numpy.nonzero(alone)
        # The same drawing a quarter as large: its extent, and its foot at the point.
        self.assertAlmostEqual(xs.max() - xs.min(), (ax.max() - ax.min()) / 4, delta=2.5)
        self.assertAlmostEqual(ys.max() - ys.min(), (ay.max() - ay.min()) / 4, delta=2.5)
        self.assertAlmostEqual(ys.max(), 150, delta=3)
        self.assertLess(abs(xs[ys == ys.max()].mean() - 220), 3)
        # Softened, it covers as much in sum, and nothing stays as dark.
        self.ok("paint", self.tree, "-o", self.path("s.png"), "--over", photo, "--at", "220,150", "--scale", "0.25", "--smooth", "0", "--soften", "1.5")
        soft = numpy.asarray(Image.open(self.path("s.png")).convert("L"), float)
        ground = placed[2, 2]
        self.assertAlmostEqual((ground - soft).sum() / (ground - placed).sum(), 1.0, delta=0.08)
        self.assertGreater(soft.min(), placed.min() + 10)

    def test_colours_of_the_photo_and_of_a_filling(self):
        photo = self.path("p.png")
        picture = numpy.full((320, 400, 3), 230, "uint8")
        picture[:40, :40] = (60, 20, 90)  # the darkest 1.25 %
        Image.fromarray(picture).save(photo)
        self.ok("paint", self.tree, "-o", self.path("o.png"), "--over", photo, "--palette", "photo")
        self.assertLess(numpy.abs(numpy.asarray(Image.open(self.path("o.png")))[280, 200].astype(int) - (60, 20, 90)).max(), 3)
        fill = numpy.zeros((160, 200, 3), "uint8")
        fill[:, :100], fill[:, 100:] = (250, 0, 0), (0, 0, 250)
        Image.fromarray(fill).save(self.path("f.png"))
        self.ok("paint", self.tree, "-o", self.path("o.png"), "--fill", self.path("f.png"), "--scale", "2")
        self.ok("paint", self.tree, "-o", self.path("plain.png"), "--scale", "2")
        ours, plain = (numpy.asarray(Image.open(self.path(n))) for n in ("o.png", "plain.png"))
        self.assertTrue((ours[..., 3] == plain[..., 3]).all())
        drawn = ours[..., 3] == 255
        expected = numpy.where(numpy.arange(400)[None, :, None] < 200, numpy.array((250, 0, 0)), numpy.array((0, 0, 250)))
        away = numpy.abs(numpy.arange(400) - 199.5) > 4
        self.assertLess(numpy.abs(ours[..., :3].astype(int) - expected)[:, away][drawn[:, away]].max(), 3)

    def test_what_stands_behind_is_paler_and_cut_out_by_a_rim(self):
        bar = "# ramify canvas 120 120\n1 0 {0} {1} 0 6 -1\n2 0 {2} {3} 0 6 1\n"
        front, back = self.path("front.swc", bar.format(10, 60, 110, 60)), self.path("back.swc", bar.format(60, 110, 60, 10))
        options = ["--background", "#ffffff", "--palette", "#000000", "--taper", "0", "--smooth", "0"]
        self.ok("paint", front, "--behind", back, "-o", self.path("o.png"), "--pale", "0.5", "--rim", "4", *options)
        picture = numpy.asarray(Image.open(self.path("o.png")).convert("L"), int)
        self.assertLess(picture[60, 30], 10)                       # the front
        self.assertLess(picture[60, 60], 10)                       # also where it crosses
        self.assertTrue(80 < picture[100, 60] < 200)               # the back is grey
        self.assertGreater(picture[60 + 8, 60], 250)               # between them ground
        self.assertGreater(picture[60 - 8, 60], 250)
        for kind in ("png", "svg"):
            self.ok("paint", front, "--behind", back, back, "-o", self.path("again." + kind), *options)
            self.ok("replay", self.path("again." + kind), "-o", self.path("replayed." + kind))
            self.assertEqual(self.digest(self.path("again." + kind)), self.digest(self.path("replayed." + kind)))

    def test_watercolour_dries_dark_along_its_rim_and_in_the_papers_hollows(self):
        broad = self.path("t.swc", "# ramify canvas 400 200\n1 0 40 100 0 30 -1\n2 0 360 100 0 30 1\n")
        options = ["--style", "watercolor", "--palette", "#806040", "--smooth", "0", "--taper", "0"]

        def painted(*extra):
            self.ok("paint", broad, "-o", self.path("o.png"), *options, *extra)
            return numpy.asarray(Image.open(self.path("o.png")).convert("RGB"), float) / 255

        white = painted("--background", "#ffffff")
        light = white[:, 120:320].mean(axis=2)
        top = numpy.argmax(light < 0.97, axis=0)  # the strokes' rim in every column, ragged
        rim = numpy.mean([light[t + 1:t + 3, x].mean() for x, t in enumerate(top)])
        inside = numpy.mean([light[t + 6:t + 10, x].mean() for x, t in enumerate(top)])
        self.assertLess(rim, inside - 0.05)
        self.assertGreater(light[90:110].std(), 0.02)  # pigment in the paper's hollows
        self.assertEqual(white[5, 5].tolist(), [1, 1, 1])  # the paper stays
        # Pigment is transparent: what it takes from white it takes from any ground, channel by channel.
        ground = numpy.array([0x40, 0xa0, 0xe0]) / 255
        self.assertLess(numpy.abs(painted("--background", "#40a0e0") - white * ground).max(), 1.6 / 255)
        # Without a ground it looks on white as it does on white.
        self.ok("paint", broad, "-o", self.path("o.png"), *options)
        bare = over(numpy.asarray(Image.open(self.path("o.png")).convert("RGBA"), float) / 255, 1.0)
        self.assertLess(numpy.abs(bare - white).max(), 2.6 / 255)
        # The paper is the canvas's: twice as large is the same picture.
        self.ok("paint", broad, "-o", self.path("o.png"), *options, "--background", "#ffffff", "--scale", "2")
        halved = numpy.asarray(Image.open(self.path("o.png")).convert("RGB").resize((400, 200), Image.BOX), float) / 255
        self.assertLess(numpy.abs(halved - white).mean(), 0.01)
        self.assertGreater(numpy.corrcoef(halved[90:110].mean(axis=2).ravel(), white[90:110].mean(axis=2).ravel())[0, 1], 0.9)

    def test_washes_do_not_darken_where_branches_overlap(self):
        tree = self.path("t.swc", "# ramify canvas 200 200\n1 0 20 100 0 12 -1\n2 0 100 100 0 12 1\n3 0 180 100 0 12 2\n4 0 100 20 0 12 2\n")
        self.ok("paint", tree, "-o", self.path("o.svg"), "--style", "watercolor", "--background", "#ffffff")
        root = ET.parse(self.path("o.svg")).getroot()
        washes = [g for g in root.iter(SVG + "g") if g.get("opacity")]
        self.assertGreaterEqual(len(washes), 2)
        self.assertTrue(all("multiply" in g.get("style", "") for g in washes))
        self.assertTrue(all(p.get("fill-opacity") is None for g in washes for p in g))

    def test_pillow_plays_the_animation(self):
        out = self.path("a.webp")
        self.ok("paint", self.tree, "-o", out, "--style", "vine", "--animate", "--frames", "12", "--fps", "20", "--hold", "1")
        film = Image.open(out)
        self.assertEqual((film.n_frames, film.size), (12, (200, 160)))
        covered = []
        for i in range(12):
            film.seek(i)
            film.load()
            covered.append(int((numpy.asarray(film.convert("RGBA"))[..., 3] > 128).sum()))
        self.assertTrue(all(b >= a - 20 for a, b in zip(covered, covered[1:])), covered)
        self.assertLess(covered[0], 0.2 * covered[-1])
        self.ok("paint", self.tree, "-o", self.path("still.png"), "--style", "vine")
        still = numpy.asarray(Image.open(self.path("still.png")).convert("RGBA"))[..., 3]
        self.assertLess(abs(covered[-1] - int((still > 128).sum())), 30)

    def test_frames_are_numbered_and_each_can_be_made_again(self):
        self.ok("paint", self.tree, "-o", self.path("f.png"), "--animate", "--frames", "3")
        self.assertEqual(sorted(os.listdir(self.dir)), ["f_0000.png", "f_0001.png", "f_0002.png", "tree.swc"])
        self.ok("replay", self.path("f_0001.png"), "-o", self.path("again.png"))
        self.assertEqual(self.digest(self.path("f_0001.png")), self.digest(self.path("again.png")))

    def test_same_bytes_for_threads_and_replay(self):
        for name, extra in (("a.png", []), ("a.svg", []), ("a.webp", ["--animate", "--frames", "4"]), ("a.tif", ["--depth", "16"])):
            made = set()
            for threads in (1, 2, 8):
                self.ok("paint", self.tree, "-o", self.path(name), "--preset", "blossom", "--seed", "7", "--threads", threads, *extra)
                made.add(self.digest(self.path(name)))
            again = self.path("again" + name[1:])
            self.ok("replay", self.path(name), "-o", again)
            made.add(self.digest(again))
            self.assertEqual(len(made), 1, name)

    def test_presets(self):
        listed = json.loads(self.ok("paint", "--preset", "list", "--json").stdout)
        self.assertGreater(len(listed), 8)
        for preset in listed:
            self.ok("paint", self.tree, "-o", self.path("a.png"), "--preset", preset["name"])
        self.fails(2, "did you mean ivy", "paint", self.tree, "-o", self.path("b.png"), "--preset", "ivi")
        self.ok("paint", self.tree, "-o", self.path("a.svg"), "--preset", "ivy", "--leaf", "oak")  # the flag wins
        self.assertIn('"leaf":"oak"', pathlib.Path(self.path("a.svg")).read_text().replace(" ", ""))

    def test_options_without_effect_are_refused(self):
        out = self.path("a.png")
        for extra in (["--leaf", "oak"], ["--glow", "2"], ["--style", "lightning", "--flowers", "0.5"], ["--fps", "10"],
                      ["--animate", "--fps", "10"], ["--animate", "--growth", "0.5"], ["--size", "100x100", "--scale", "2"]):
            self.fails(2, "no effect", "paint", self.tree, "-o", out, *extra)
        self.fails(2, "no effect", "paint", self.tree, "-o", self.path("a.svg"), "--depth", "16")
        self.fails(2, "transparency", "paint", self.tree, "-o", self.path("a.jpg"))
        photo = self.path("p.png")
        Image.new("RGB", (20, 20)).save(photo)
        self.fails(2, "photo", "paint", self.tree, "-o", self.path("a.svg"), "--over", photo)
        self.fails(2, "no effect", "paint", self.tree, "-o", out, "--over", photo, "--background", "#fff")
        for extra in (["--at", "3,3"], ["--pale", "0.2"], ["--rim", "2"], ["--hatching", "0.3"], ["--over", photo, "--at", "3,3", "--size", "9x9"],
                      ["--style", "lightning", "--soften", "1"], ["--style", "lightning", "--behind", self.tree]):
            self.fails(2, "no effect", "paint", self.tree, "-o", out, *extra)
        self.fails(2, "outside the photo", "paint", self.tree, "-o", out, "--over", photo, "--at", "20,3")
        self.fails(2, "one point", "paint", self.tree, "-o", out, "--over", photo, "--at", "2,3 4,5")
        self.fails(2, "--over", "paint", self.tree, "-o", out, "--palette", "photo")
        self.fails(2, "plain ground", "paint", self.tree, "-o", out, "--over", photo, "--behind", self.tree)
        self.fails(3, "proportions", "paint", self.tree, "-o", out, "--fill", photo)
        self.fails(3, "nowhere.png", "paint", self.tree, "-o", out, "--fill", "nowhere.png")
        self.fails(3, "canvas of", "paint", self.tree, "-o", out, "--behind", self.path("small.swc", "# ramify canvas 30 20\n1 0 15 10 0 4 -1\n"))
        self.fails(2, "no effect", "paint", self.tree, "-o", self.path("a.svg"), "--soften", "2")
        self.fails(2, "no picture", "paint", self.tree, "-o", self.path("a.svg"), "--fill", photo)

    def test_bad_values_and_files(self):
        out = self.path("a.png")
        for extra in (["--palette", "red"], ["--background", "blue"], ["--frames", "1e9", "--animate"], ["--scale", "0"], ["--scale", "nan"],
                      ["--stile", "ink"], ["--style", "inc"], ["--size", "0x4"], ["--depth", "12"], ["--seed", "1e3"], ["--width", "-1"]):
            self.fails(2, "", "paint", self.tree, "-o", out, *extra)
        self.fails(2, "", "paint", self.tree)
        self.fails(2, "", "paint", "-o", out)
        self.fails(2, ".svg", "paint", self.tree, "-o", self.path("a.pdf"))
        self.fails(3, "no nodes", "paint", self.path("e.json", '{"format":"ramify-skeleton","version":1,"size":[9,9],"dim":2,"nodes":[]}'), "-o", out)
        self.fails(3, "", "paint", self.path("no.swc"), "-o", out)
        self.fails(3, "", "paint", self.path("junk.swc", b"\0\1\2"), "-o", out)
        self.fails(5, "MiB", "paint", self.tree, "-o", out, "--size", "1000000x1000000")
        self.fails(5, "", "paint", self.tree, "-o", out, "--scale", "100", "--limit-pixels", "1e6")
        self.fails(4, "folder", "paint", self.tree, "-o", self.path("nowhere/a.png"))

    def test_no_clobber_and_odd_skeletons(self):
        out = self.path("a.svg", "mine")
        self.ok("paint", self.tree, "-o", out, "--no-clobber")
        self.assertEqual(pathlib.Path(out).read_text(), "mine")
        dot = self.path("dot.swc", "# ramify canvas 30 20\n1 0 15 10 0 4 -1\n")
        twice = self.path("twice.swc", "# ramify canvas 30 20\n1 0 15 10 0 4 -1\n2 0 15 10 0 4 1\n3 0 15 10 0 1e-9 2\n4 0 900 10 0 300 1\n")
        for skeleton in (dot, twice):
            for style in ("ink", "vine", "lightning", "woodcut", "watercolor"):
                for kind in ("png", "svg"):
                    self.ok("paint", skeleton, "-o", self.path("o." + kind), "--style", style)
        for style in ("woodcut", "watercolor"):
            for growth in ("0", "0.05", "0.3", "0.7"):
                self.ok("paint", self.tree, "-o", self.path("o.svg"), "--style", style, "--growth", growth)


if __name__ == "__main__":
    unittest.main()
