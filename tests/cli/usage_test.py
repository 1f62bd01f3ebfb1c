# SPDX-License-Identifier: GPL-3.0-or-later
"""Words on the command line: verbs, options, names of files (RELIABILITY rows 18, 19, 33, 34, 46)."""
import os
import pathlib
import socket
import unittest

from harness import CliTest, png


class Usage(CliTest):
    def test_help_and_version(self):
        self.assertRegex(self.ok("--version").stdout, r"^ramify \d+\.\d+\.\d+\n$")
        verbs = ["synth", "grow", "render", "trace", "rectify", "complete", "exemplar", "dendrite", "stylize", "moss", "figure", "paint", "compare", "convert", "replay", "info"]
        top = self.ok("--help").stdout
        for verb in verbs:
            self.assertIn(verb, top)
            self.assertIn("Example", self.ok(verb, "--help").stdout)

    def test_unknown_words_get_a_suggestion(self):
        self.fails(2, "Did you mean synth?", "snyth")
        self.fails(2, "Did you mean --tropism?", "synth", self.exemplar, "-o", "a.png", "--tropsim", "1")
        self.fails(2, "--help", "synth")
        self.fails(2, "--help")
        self.fails(2, ["no verb 'snyth'"], "snyth")
        self.fails(2, ["unknown option --tropsim"], "synth", self.exemplar, "-o", "a.png", "--tropsim", "1")
        self.fails(2, ["unknown option --thinnest", "option of figure"], "synth", self.exemplar, "-o", "a.png", "--thinnest", "1")
        done = self.fails(2, "'j.json' is one word too many", "dendrite", "j.json", "-o", "a.json")
        self.assertNotIn("Did you mean", done.stderr)
        self.fails(2, "--output: a value must follow", "synth", self.exemplar, "-o")
        self.fails(2, "more than once", "synth", self.exemplar, "-o", "a.png", "-o", "b.png")
        self.fails(2, "--text", "figure", "-o", "a.svg")

    def test_an_empty_value_is_no_value(self):
        self.fails(2, "--text: is empty", "dendrite", "--text", "", "-o", "a.json")
        self.fails(2, "--density: is empty", "grow", self.exemplar, "--density", "", "-o", "a.json")
        self.fails(2, "photo: is empty", "trace", "", "-o", "a.ramify.json")
        skeleton = self.path("s.json")
        self.ok("dendrite", "--size", "40x40", "--count-endpoints", "4", "-o", skeleton)
        self.ok("paint", skeleton, "--palette", "", "-o", "a.svg")

    def test_flags_can_be_denied(self):
        plain, denied = self.path("plain.json"), self.path("denied.json")
        words = ["dendrite", "--size", "40x40", "--count-endpoints", "4", "-o"]
        self.ok(*words, plain)
        self.ok(*words, denied, "--edge-weights=false")
        self.assertEqual(self.digest(plain), self.digest(denied))

    def test_numbers(self):
        out = ("-o", "a.png")
        for seed in ["1e3", "-1", "0x10", "18446744073709551616", "seven", "1.0", ""]:
            self.fails(2, "--seed", "synth", self.exemplar, *out, "--seed", seed)
        for count in ["0", "-1", "9223372036854775808", "1.5", "1e3", "many"]:
            self.fails(2, "--count", "synth", self.exemplar, *out, "--count", count)
        for size in ["0x10", "-5x5", "10", "10x", "ax5", "10x10x10"]:
            self.fails(2, "size", "synth", self.exemplar, *out, "--size", size)
        self.fails(2, "--tropism", "synth", self.exemplar, *out, "--tropism", "9")
        self.fails(2, "--roots", "synth", self.exemplar, *out, "--roots", "1")
        self.fails(2, "--depth", "synth", self.exemplar, *out, "--depth", "12")
        self.fails(2, "--depth", "synth", self.exemplar, "-o", "a.jpg", "--depth", "16")
        self.fails(2, "--background", "synth", self.exemplar, *out, "--background", "blue")
        self.fails(2, "from 1 to 100000\n", "synth", self.exemplar, *out, "--count", "0")

    def test_canvas_limit_is_known_before_work(self):
        self.fails(5, ["MiB", "limit"], "synth", self.exemplar, "-o", "a.png", "--size", "1000000x1000000", timeout=5)

    def test_output_names(self):
        self.fails(2, ".png", "synth", self.exemplar, "-o", "a.bmp")
        self.fails(4, "folder does not exist", "synth", self.exemplar, "-o", "missing/a.png")
        os.symlink("target.png", self.path("link.png"))
        self.fails(4, "symbolic link", "synth", self.exemplar, "-o", "link.png")
        os.mkdir(self.path("folder.png"))
        self.fails(4, "is a folder", "synth", self.exemplar, "-o", "folder.png")
        self.fails(4, "too long", "synth", self.exemplar, "-o", "x" * 300 + ".png")
        self.fails(4, "two outputs", "synth", self.exemplar, "-o", "a.png", "--mask", "./a.png")

    def test_outputs_are_checked_before_inputs_are_read(self):
        broken = self.path("broken.ramify.json", b"{")
        self.fails(4, "folder does not exist", "synth", broken, "-o", "missing/a.png")
        self.fails(4, "folder does not exist", "dendrite", "-o", "a.json", "--timings", "missing/t.json")

    def test_a_locked_folder_is_known_before_work(self):
        os.mkdir(self.path("locked"), 0o555)
        os.chmod(self.dir, 0o755)
        user = {"user": 65534} if os.getuid() == 0 else {}  # to root nothing is locked
        try:
            self.ok("--version", **user)
        except PermissionError:
            self.skipTest("the program lies where only root can run it")
        self.fails(4, "no permission", "synth", self.path("broken.ramify.json", b"{"), "-o", "locked/a.png", **user)

    def test_inputs_are_there_before_work(self):
        for option in ["--density", "--guide", "--regions"]:
            self.fails(3, "missing.png: no such file", "grow", self.path("broken.ramify.json", b"{"), option, "missing.png", "-o", "a.json")

    def test_the_input_is_never_overwritten(self):
        before = self.digest(self.photo)
        done = self.run_cli("synth", self.exemplar, "-o", self.photo)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(self.digest(self.photo), before)

    def test_timings_overwrite_nothing(self):
        skeleton = self.path("s.json")
        self.ok("dendrite", "--size", "40x40", "--count-endpoints", "4", "-o", skeleton)
        before = self.digest(skeleton)
        self.fails(4, "also an input", "paint", skeleton, "--timings", skeleton, "-o", "a.png")
        self.fails(4, "also an input", "info", skeleton, "--timings", skeleton)
        self.fails(4, "two outputs", "dendrite", "-o", "b.json", "--timings", "./b.json")
        self.assertEqual(self.digest(skeleton), before)

    def test_replay_overwrites_no_input(self):
        skeleton, photo = self.path("s.json"), self.path("photo.png", pathlib.Path(self.photo).read_bytes())
        self.ok("dendrite", "--size", "40x40", "--count-endpoints", "4", "-o", skeleton)
        self.ok("paint", skeleton, "--over", photo, "-o", "painted.png")
        before = self.digest(photo)
        self.fails(4, "also an input", "replay", "painted.png", "-o", photo)
        bitmap = self.path("bitmap.png", png(60, 60, lambda x, y: (0, 0, 0) if 10 < x < 50 and 10 < y < 50 else (255, 255, 255)))
        self.ok("figure", bitmap, "-o", "filled.png")
        self.fails(4, "also an input", "replay", "filled.png", "-o", bitmap)
        self.assertEqual(self.digest(photo), before)

    def test_no_clobber_keeps_what_is_there(self):
        out = self.path("a.png", b"mine")
        done = self.ok("synth", self.exemplar, "-o", out, "--no-clobber")
        self.assertIn("kept", done.stderr)
        self.assertEqual(pathlib.Path(out).read_bytes(), b"mine")

    def test_inputs_that_are_no_files(self):
        os.mkfifo(self.path("pipe"))
        s = socket.socket(socket.AF_UNIX)
        s.bind(self.path("socket"))
        self.addCleanup(s.close)
        for name in ["pipe", "socket", ".", "/dev/zero", "missing.png"]:
            self.fails(3, "", "trace", name, "-o", "a.ramify.json", timeout=5)

    def test_strange_names_work(self):
        picture = png(64, 48, lambda x, y: (40, 40, 40) if abs(y - 24) < 3 else (200, 200, 200))
        for name in ["with space.png", "ünï.png", "new\nline.png", "x" * 250 + ".png"]:
            self.path(name, picture)
            self.assertEqual(self.ok("info", "--json", name).returncode, 0)
        self.path("-x.png", picture)
        self.ok("info", "--", "-x.png")
        self.fails(3, "", "info", "y" * 4200)

    def test_escape_sequences_are_not_echoed(self):
        done = self.fails(3, "\\x1b", "info", "a\x1b[31mb.png")
        self.assertNotIn("\x1b", done.stderr)


if __name__ == "__main__":
    unittest.main()
