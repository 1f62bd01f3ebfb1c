# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad inputs at the program's edge (RELIABILITY rows 1 to 5, 8, 9, 17, 20 to 23, 25, 26, 30 to 32)."""
import json
import pathlib
import random
import resource
import struct
import subprocess
import unittest
import zlib

import numpy
from PIL import Image

from harness import BIN, SANITIZED, CliTest, png


class Pictures(CliTest):
    def test_what_is_no_picture(self):
        for name, content, says in [("empty.png", b"", "empty"), ("text.png", b"hello there, this is text\n", "text"),
                                    ("page.png", b"<!DOCTYPE html><html></html>", "HTML"),
                                    ("zip.png", b"PK\x03\x04" + b"\0" * 40, "ZIP"), ("gif.png", b"GIF89a" + b"\0" * 40, "GIF")]:
            self.path(name, content)
            self.fails(3, [name, says], "trace", name, "-o", "a.ramify.json")

    def test_a_wrong_extension_only_warns(self):
        self.path("photo.jpg", pathlib.Path(self.photo).read_bytes())
        done = self.ok("trace", "photo.jpg", "-o", "a.ramify.json")
        self.assertEqual(done.stderr.count("note:"), 1, done.stderr)

    def test_cut_pictures(self):
        whole = pathlib.Path(self.photo).read_bytes()
        for percent in range(1, 100, 7):
            self.path("cut.png", whole[:len(whole) * percent // 100])
            self.fails(3, "cut.png", "trace", "cut.png", "-o", "a.ramify.json")
        self.ok("synth", self.exemplar, "-o", "photo.jpg")
        whole = pathlib.Path(self.path("photo.jpg")).read_bytes()
        for percent in range(1, 100, 7):
            self.path("cut.jpg", whole[:len(whole) * percent // 100])
            self.fails(3, "cut.jpg", "trace", "cut.jpg", "-o", "a.ramify.json")
        self.path("cut.jpg", whole[:len(whole) * 9 // 10])
        self.assertIn("note:", self.ok("trace", "cut.jpg", "-o", "a.ramify.json", "--allow-truncated").stderr)

    def test_a_bomb_is_refused_before_it_is_unpacked(self):
        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        packer = zlib.compressobj(9)
        rows = b"".join(packer.compress(b"\0" * 4001) for _ in range(32000)) + packer.flush()
        bomb = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 32000, 32000, 1, 0, 0, 0, 0)) +
                chunk(b"IDAT", rows) + chunk(b"IEND", b""))
        self.path("bomb.png", bomb)
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
        script = ("import resource,subprocess,sys;c=subprocess.run(sys.argv[1:],capture_output=True).returncode;"
                  "print(c,resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)")
        done = subprocess.run(["/usr/bin/python3", "-c", script, BIN, "trace", self.path("bomb.png"), "-o", self.path("a.ramify.json")],
                              capture_output=True, text=True, timeout=20)
        code, kilobytes = map(int, done.stdout.split())
        self.assertEqual(code, 5)
        # Its pixels would take 1000 MiB. AddressSanitizer's own memory comes on top.
        self.assertLess(kilobytes, (400 if SANITIZED else 100) * 1024, before)

    def test_sizes_that_cannot_be(self):
        for w, h, code in [(0, 5, 3), (2**31 - 1, 2**31 - 1, 5), (2**31, 1, 3), (100000, 100000, 5)]:
            self.path("size.png", png(4, 4, claim=(w, h)))
            done = self.run_cli("trace", "size.png", "-o", "a.ramify.json", timeout=10)
            self.assertIn(done.returncode, (3, 5), (w, h, done.stderr))

    def test_pictures_without_branches(self):
        noise = random.Random(1)
        for name, pixel in [("black", lambda x, y: (0, 0, 0)), ("white", lambda x, y: (255, 255, 255)),
                            ("noise", lambda x, y: [noise.randrange(256) for _ in range(3)])]:
            self.path(name + ".png", png(160, 120, pixel))
            self.fails(3, "no branches", "trace", name + ".png", "-o", "a.ramify.json")

    def test_tiny_and_thin_pictures(self):
        for size in [(1, 1), (1, 2000), (2000, 1), (7, 7)]:
            self.path("small.png", png(*size))
            self.fails(3, "", "trace", "small.png", "-o", "a.ramify.json")


class Annotations(CliTest):
    def setUp(self):
        super().setUp()
        self.good = pathlib.Path(self.exemplar).read_text()
        self.path("crack.png", pathlib.Path(self.photo).read_bytes())

    def refuse(self, text, *says):
        self.path("bad.ramify.json", text)
        self.fails(3, ["bad.ramify.json", *says], "grow", "bad.ramify.json", "-o", "a.swc", timeout=20)

    def edited(self, change):
        value = json.loads(self.good)
        change(value)
        return json.dumps(value)

    def test_a_built_in_exemplar_is_described_like_a_file(self):
        facts = json.loads(self.ok("info", "builtin:crack", "--json").stdout)
        self.assertEqual(facts["kind"], "built-in exemplar")
        self.assertGreater(facts["skeleton"]["branches"], 5)
        self.assertGreater(facts["style"]["step_px"], 0)
        self.fails(3, ["builtin:puddle", "lightning"], "info", "builtin:puddle")

    def test_a_bare_photo_names_trace(self):
        self.fails(3, "ramify trace", "synth", "crack.png", "-o", "a.png")

    def test_malformed_text_is_placed(self):
        self.refuse(self.good[:len(self.good) // 2], "line")
        self.refuse(self.good.replace('"branches"', '"branches" oops', 1), "line")
        for at in range(1, len(self.good), max(1, len(self.good) // 40)):
            self.path("bad.ramify.json", self.good[:at])
            self.assertEqual(self.run_cli("grow", "bad.ramify.json", "-o", "a.swc").returncode, 3)

    def test_depth_and_numbers(self):
        self.path("deep.ramify.json", '{"format":"ramify-annotation","x":' + "[" * 100000 + "]" * 100000 + "}")
        self.fails(5, ["deep.ramify.json", "64"], "grow", "deep.ramify.json", "-o", "a.swc", timeout=20)
        for value in ["NaN", "Infinity", "1e400", '"12"', "null"]:
            self.refuse(self.good.replace('"version": 1', f'"version": {value}', 1).replace('"version":1', f'"version":{value}', 1))

    def test_wrong_values_are_named_by_their_path(self):
        self.refuse(self.edited(lambda v: v["branches"][0]["points"][0].__setitem__(2, "wide")), "branches", "points")
        self.refuse(self.edited(lambda v: v["branches"][-1].__setitem__("parent", {"branch": 999, "point": 0})), "branches")
        self.refuse(self.edited(lambda v: v.__setitem__("version", 99)), "newer")
        self.refuse(self.edited(lambda v: v.__setitem__("branches", [])), "branch")
        self.refuse(self.good.replace('"format"', '"format":"ramify-annotation","format"', 1), "format")

    def test_another_photo_is_refused_unless_allowed(self):
        other = self.edited(lambda v: v["photo"].__setitem__("sha256", "0" * 64))
        self.refuse(other, "--allow-other-photo")
        self.path("other.ramify.json", other)
        self.ok("grow", "other.ramify.json", "-o", self.path("a.swc"), "--allow-other-photo")

    def test_a_skeleton_on_another_canvas_is_refused_unless_allowed(self):
        skeleton = self.path("skeleton.json")
        self.ok("convert", self.exemplar, "-o", skeleton)
        self.ok("grow", self.photo, "--annotation", skeleton, "-o", self.path("same.swc"))
        value = json.loads(pathlib.Path(skeleton).read_text())
        value["size"] = [80, 60]
        self.path("skeleton.json", json.dumps(value))
        self.fails(3, ["skeleton.json", "80x60", "240x180"], "grow", self.photo, "--annotation", skeleton, "-o", "a.swc")
        self.ok("grow", self.photo, "--annotation", skeleton, "-o", self.path("a.swc"), "--allow-other-photo")
        self.fails(3, "--annotation FILE", "synth", skeleton, "-o", "a.png")

    def test_a_missing_photo_says_where_it_was_looked_for(self):
        self.refuse(self.edited(lambda v: v["photo"].__setitem__("file", "gone.png")), "gone.png", "RAMIFY_PHOTOS")

    def test_random_damage_never_crashes(self):
        rng = random.Random(7)
        for _ in range(60):
            text = bytearray(self.good.encode())
            for _ in range(rng.randrange(1, 6)):
                text[rng.randrange(len(text))] = rng.randrange(256)
            self.path("bad.ramify.json", bytes(text))
            done = self.run_cli("info", "bad.ramify.json", timeout=20)
            self.assertIn(done.returncode, (0, 3), done.stderr)


class MapsAndSkeletons(CliTest):
    def test_density_maps(self):
        self.path("black.png", png(240, 180, lambda x, y: (0, 0, 0)))
        self.fails(3, "nothing to grow", "grow", self.exemplar, "-o", "a.swc", "--density", "black.png")
        self.path("half.png", png(120, 90, lambda x, y: (255, 255, 255) if x > 60 else (0, 0, 0)))
        done = self.ok("grow", self.exemplar, "-o", "a.swc", "--density", "half.png")
        self.assertIn("resized", done.stderr)
        text = pathlib.Path(self.path("a.swc")).read_text()
        rows = [line.split() for line in text.splitlines() if not line.startswith("#")]
        self.assertGreater(len(rows), 10)
        self.assertTrue(all(float(row[2]) > 119 for row in rows))
        # Three channels that say the same, and real numbers with gaps, grow the same.
        grown = self.digest(self.path("a.swc"))
        Image.open(self.path("half.png")).convert("L").save(self.path("grey.png"))
        values = numpy.full((90, 120), numpy.nan, numpy.float32)
        values[:, 61:] = 1.0
        Image.fromarray(values).save(self.path("gaps.tif"))
        for name in ("grey.png", "gaps.tif"):
            self.ok("grow", self.exemplar, "-o", "a.swc", "--density", name)
            self.assertEqual(self.digest(self.path("a.swc")), grown, name)
        Image.fromarray(numpy.full((90, 120), numpy.nan, numpy.float32)).save(self.path("none.tif"))
        self.fails(3, "nothing to grow", "grow", self.exemplar, "-o", "b.swc", "--density", "none.tif")

    def test_guides(self):
        self.path("bad.svg", '<!DOCTYPE svg [<!ENTITY a "b">]><svg><text>&a;</text></svg>')
        self.fails(3, "bad.svg", "grow", self.exemplar, "-o", "a.swc", "--guide", "bad.svg")
        self.path("good.svg", '<svg viewBox="0 0 240 180"><script>alert(1)</script><path d="M10 90 C 80 10 160 170 230 90"/></svg>')
        self.ok("grow", self.exemplar, "-o", "a.swc", "--guide", "good.svg")

    def test_skeletons_for_render(self):
        self.path("cycle.swc", "1 2 10 10 0 1 2\n2 2 60 60 0 1 1\n")
        self.assertIn("cut open", self.ok("render", self.exemplar, "cycle.swc", "-o", self.path("b.png"), "--size", "80x80").stderr)
        for name, text in [("words.swc", "a b c d e f g\n"), ("none.swc", "# nothing\n"),
                           ("nan.swc", "1 2 nan 0 0 1 -1\n2 2 1 1 0 1 1\n")]:
            self.path(name, text)
            self.fails(3, name, "render", self.exemplar, name, "-o", "a.png", timeout=30)

    def test_perspective_corners(self):
        for corners in ["0,0 10,0 20,0 0,50", "0,0 100,100 100,0 0,100", "0,0 0,0 0,0 0,0", "1,2 3,4", "a,b c,d e,f g,h"]:
            done = self.run_cli("rectify", self.photo, "--corners", corners, "-o", "a.png")
            self.assertIn(done.returncode, (2, 3), (corners, done.stderr))


if __name__ == "__main__":
    unittest.main()
