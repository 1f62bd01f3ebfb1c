# SPDX-License-Identifier: GPL-3.0-or-later
"""Every option that takes a file, given files that are cut, garbled, empty or of another kind: refused with one sentence that
names the file, or used; never a crash, never a file half written."""
import os
import pathlib
import random
import unittest

from harness import CliTest, png

# The files' kinds, and how each is made whole.
KINDS = ["annotation", "png", "tif", "exr", "webp", "jpg", "swc", "json", "svg"]


class Damage(CliTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.whole = {"annotation": pathlib.Path(cls.exemplar).read_bytes(), "png": png(240, 180, lambda x, y: [255 * (x > 90)] * 3)}
        test = cls()
        test.dir = cls.small
        for kind in ["tif", "exr", "webp", "jpg"]:
            out = str(cls.small / ("photo." + kind))
            test.ok("convert", cls.photo, "-o", out)
            cls.whole[kind] = pathlib.Path(out).read_bytes()
        for kind in ["swc", "json", "svg"]:
            out = str(cls.small / ("skeleton." + kind))
            test.ok("convert", cls.exemplar, "-o", out)
            cls.whole[kind] = pathlib.Path(out).read_bytes()

    def runTest(self):
        """For setUpClass, which needs one instance."""

    @staticmethod
    def damaged(whole, how, rng):
        if how == "empty":
            return b""
        if how == "cut":
            return whole[:rng.randrange(1, len(whole) * 9 // 10)]
        garbled = bytearray(whole)
        for _ in range(1 + len(whole) // 400):
            garbled[rng.randrange(len(garbled))] = rng.randrange(256)
        return bytes(garbled)

    def uses(self):
        """Verb, arguments with the damaged file as FILE, and the kinds the option is made for."""
        pictures = ["png", "tif", "exr", "webp", "jpg"]
        skeletons = ["swc", "json", "svg"]
        return [(("grow", "FILE", "-o", "a.swc"), ["annotation"]),
                (("grow", self.photo, "--annotation", "FILE", "-o", "a.swc"), ["annotation", "swc", "json", "svg"]),
                (("grow", self.exemplar, "--regions", "FILE", "-o", "a.swc"), pictures),
                (("grow", self.exemplar, "--density", "FILE", "-o", "a.swc"), pictures),
                (("grow", self.exemplar, "--guide", "FILE", "-o", "a.swc"), ["svg", "png"]),
                (("render", self.exemplar, "FILE", "-o", "a.png", "--size", "64x48"), skeletons),
                (("trace", "FILE", "-o", "a.ramify.json"), pictures),
                (("rectify", "FILE", "--corners", "9,9 200,12 190,160 12,170", "-o", "a.png"), pictures),
                (("complete", self.photo, "--mask", "FILE", "-o", "a.png"), ["png"]),
                (("convert", "FILE", "-o", "a.json"), skeletons), (("convert", "FILE", "-o", "a.png"), pictures),
                (("compare", self.exemplar, "FILE", "-o", "a.json"), skeletons + ["annotation", "png"]),
                (("replay", "FILE", "-o", "a.png"), ["png", "webp", "json"]), (("info", "FILE"), KINDS)]

    def test_every_option_with_every_damage(self):
        rng = random.Random(5)
        (self.dir / "crack.png").write_bytes(pathlib.Path(self.photo).read_bytes())
        read = refused = 0
        for words, kinds in self.uses():
            other = next(kind for kind in KINDS if kind not in kinds) if set(kinds) != set(KINDS) else None
            trials = [(rng.choice(kinds), how) for how in ("cut", "garbled", "garbled", "empty")] + ([(other, "whole")] if other else [])
            for kind, how in trials:
                name = f"{how}.{'ramify.json' if kind == 'annotation' else kind}"
                self.path(name, self.whole[kind] if how == "whole" else self.damaged(self.whole[kind], how, rng))
                before = set(os.listdir(self.dir))
                done = self.run_cli(*[name if word == "FILE" else word for word in words], timeout=60)
                made = set(os.listdir(self.dir)) - before
                with self.subTest(words=words, kind=kind, how=how):
                    self.assertIn(done.returncode, (0, 2, 3), done.stderr)
                    errors = [line for line in done.stderr.splitlines() if line.startswith("ramify:")]
                    self.assertEqual(len(errors), int(done.returncode != 0), done.stderr)
                    if done.returncode:
                        self.assertEqual(made, set())
                        self.assertTrue(name in done.stderr or "nothing could grow" in done.stderr, done.stderr)
                    self.assertFalse(how == "empty" and done.returncode == 0, words)
                read += done.returncode == 0
                refused += done.returncode != 0
                for path in made:
                    os.remove(self.dir / path)
        self.assertGreater(refused, 30)
        self.assertGreater(read, 3)  # some damage is harmless


if __name__ == "__main__":
    unittest.main()
