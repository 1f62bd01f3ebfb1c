# SPDX-License-Identifier: GPL-3.0-or-later
"""A whole run: same bytes, signals, limits, full disks (RELIABILITY rows 35 to 37, 39, 40, 44)."""
import glob
import json
import os
import pathlib
import pty
import resource
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from harness import BIN, SANITIZED, CliTest, png


class SameBytes(CliTest):
    def test_threads_locale_folder_and_time_zone_do_not_matter(self):
        made = set()
        runs = [dict(), dict(args=["--threads", "1"]), dict(args=["--threads", "2"]), dict(args=["--threads", "8"]),
                dict(env={"LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8", "TZ": "Asia/Tokyo"}), dict(cwd="/")]
        for i, run in enumerate(runs):
            out = self.path(f"{i}.png")
            self.ok("synth", self.exemplar, "-o", out, "--seed", "5", "--mask", self.path(f"{i}_mask.png"),
                    *run.get("args", []), env=run.get("env"), cwd=run.get("cwd"))
            made.add((self.digest(out), self.digest(self.path(f"{i}_mask.png"))))
        self.assertEqual(len(made), 1)

    def test_replay_gives_the_same_bytes(self):
        out = self.path("a.png")
        self.ok("synth", "builtin:vessel", "--size", "320x240", "-o", out, "--seed", "3", "--tropism", "0.5")
        self.ok("replay", out, "-o", self.path("b.png"))
        self.assertEqual(self.digest(out), self.digest(self.path("b.png")))
        traced = self.path("traced.png")
        self.ok("synth", self.photo, "--annotation", "auto", "-o", traced)
        self.ok("replay", traced, "-o", self.path("again.png"), env={"RAMIFY_PHOTOS": str(self.small)})
        self.assertEqual(self.digest(traced), self.digest(self.path("again.png")))

    def test_replay_finds_inputs_in_the_folders_it_is_told(self):
        out = self.path("a.png")
        self.path("map.png", png(60, 45, lambda x, y: (255, 255, 255) if x > 20 else (90, 90, 90)))
        self.ok("synth", self.exemplar, "-o", out, "--size", "120x90", "--density", "map.png")
        moved = self.dir / "moved"
        (moved / "maps").mkdir(parents=True)
        shutil.copy(out, moved / "a.png")
        shutil.move(self.path("map.png"), moved / "maps" / "renamed.png")
        told = self.fails(3, ["--inputs", "moved"], "replay", "moved/a.png", "-o", "b.png")
        self.assertIn("crack.ramify.json", told.stderr)
        self.ok("replay", "moved/a.png", "-o", "b.png", "--inputs", self.small, "--inputs", "moved/maps")
        self.assertEqual(self.digest(out), self.digest(self.path("b.png")))  # also the recipe inside: it keeps the old names
        self.ok("compare", self.exemplar, "moved/a.png", "-o", "r.json", "--inputs", self.small, "--inputs", "moved/maps")

    def test_replay_of_a_picture_from_another_photo(self):
        photo = json.loads(pathlib.Path(self.exemplar).read_text())
        photo["photo"]["sha256"] = "0" * 64
        self.path("other.ramify.json", json.dumps(photo))
        shutil.copy(self.photo, self.dir)
        self.ok("synth", "other.ramify.json", "-o", "a.png", "--size", "120x90", "--allow-other-photo")
        self.ok("replay", "a.png", "-o", "b.png")
        self.assertEqual(self.digest(self.path("a.png")), self.digest(self.path("b.png")))

    def test_replay_reads_the_recipe_in_every_format(self):
        for kind in ("tif", "webp", "exr"):
            out, again = self.path("a." + kind), self.path("b." + kind)
            self.ok("synth", self.exemplar, "-o", out, "--size", "120x90")
            self.ok("replay", out, "-o", again, env={"RAMIFY_PHOTOS": str(self.small)})
            self.assertEqual(self.digest(out), self.digest(again))
        jpg = self.path("c.jpg")
        self.ok("synth", self.exemplar, "-o", jpg)
        self.ok("replay", jpg, "-o", self.path("d.jpg"), env={"RAMIFY_PHOTOS": str(self.small)})
        self.assertEqual(self.digest(jpg), self.digest(self.path("d.jpg")))

    def test_another_seed_gives_another_picture_and_count_numbers_them(self):
        self.ok("synth", self.exemplar, "-o", self.path("a.png"), "--count", "2", "--seed", "4", "--skeleton", self.path("a.swc"))
        self.assertEqual(sorted(os.listdir(self.dir)), ["a_0000.png", "a_0000.swc", "a_0001.png", "a_0001.swc"])
        self.assertNotEqual(self.digest(self.path("a_0000.swc")), self.digest(self.path("a_0001.swc")))
        self.ok("synth", self.exemplar, "-o", self.path("b.png"), "--seed", "5")
        self.assertEqual(self.digest(self.path("b.png")), self.digest(self.path("a_0001.png")))

    def test_json_output_and_timings(self):
        done = self.ok("synth", self.exemplar, "-o", self.path("a.png"), "--json", "--progress", "json", "--timings", self.path("t.json"))
        result = json.loads(done.stdout)
        self.assertEqual(result["outputs"], [self.path("a.png")])
        progress = [json.loads(line)["progress"] for line in done.stderr.splitlines()]
        self.assertEqual(progress, sorted(progress))
        self.assertGreater(len(progress), 3)
        stages = {row["stage"] for row in json.loads(pathlib.Path(self.path("t.json")).read_text())}
        self.assertTrue({"load", "synth", "synth/grow", "synth/compose"} <= stages, stages)


class Signals(CliTest):
    def start(self, *extra, **kwargs):
        job = subprocess.Popen([BIN, "synth", "builtin:river", "--count", "50", "-o", self.path("a.png"), *extra], cwd=self.dir,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **kwargs)
        self.wait_until_it_listens(job)
        return job

    def wait_until_it_listens(self, job):
        """Until the program catches SIGTERM: before, while its libraries are loaded, a signal ends any program."""
        status = pathlib.Path(f"/proc/{job.pid}/status")
        end = time.monotonic() + 20
        while job.poll() is None and time.monotonic() < end:
            caught = next(line for line in status.read_text().splitlines() if line.startswith("SigCgt:"))
            if int(caught.split()[1], 16) >> (signal.SIGXCPU - 1) & 1:  # the last that is asked for
                return
            time.sleep(0.01)
        self.fail("the program did not begin to catch signals")

    def test_stops_at_once_and_leaves_nothing_half_written(self):
        for sig, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 143)):
            for delay in (0.0, 0.1, 1.1):
                job = self.start()
                time.sleep(delay)
                job.send_signal(sig)
                start = time.monotonic()
                _, err = job.communicate(timeout=10)
                self.assertLess(time.monotonic() - start, 1.5)  # 0.2 s alone on the machine; tests share it
                self.assertEqual(job.returncode, code, err)
                self.assertEqual(glob.glob(self.path(".ramify*")) + glob.glob(self.path("*.part*")), [])

    def test_the_second_signal_ends_it_at_once(self):
        job = self.start()
        time.sleep(0.3)
        job.send_signal(signal.SIGINT)
        job.send_signal(signal.SIGINT)
        job.communicate(timeout=2)
        self.assertEqual(job.returncode, 130)
        self.assertEqual(glob.glob(self.path(".ramify*")), [])

    def test_a_closed_pipe_is_no_error(self):
        done = subprocess.run(f"'{BIN}' info --limits | head -c 1", shell=True, capture_output=True, text=True, timeout=20)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_a_bar_with_the_time_left_on_a_terminal_only(self):
        lead, follow = pty.openpty()
        job = subprocess.Popen([BIN, "synth", "builtin:vessel", "--size", "480x360", "-o", self.path("a.png")], stderr=follow,
                               env=dict(os.environ, TERM="xterm"))
        os.close(follow)
        shown = b""
        try:
            while chunk := os.read(lead, 4096):
                shown += chunk
        except OSError:
            pass
        self.assertEqual(job.wait(timeout=60), 0)
        self.assertRegex(shown, rb"\r.*\[#+-*\] +\d+ %.* left")
        self.assertNotIn("[#", self.ok("synth", self.exemplar, "-o", self.path("b.png")).stderr)


class Limits(CliTest):
    def test_timeout(self):
        self.fails(5, "--timeout", "synth", "builtin:river", "--count", "1000", "-o", self.path("a.png"), "--timeout", "0.2")

    def test_a_limit_of_processor_time(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (1, 5))
        self.fails(5, "processor time", "synth", "builtin:river", "--count", "1000", "-o", self.path("a.png"), "--no-clobber",
                   "--threads", "1", "--size", "4000x4000", preexec_fn=limit)

    @unittest.skipIf(SANITIZED, "AddressSanitizer reserves more address space than any such limit")
    def test_little_memory_is_an_error_or_enough(self):
        seen = set()
        for mebibytes in range(150, 1250, 100):
            def limit(size=mebibytes << 20):
                resource.setrlimit(resource.RLIMIT_AS, (size, size))
            out = self.path("a.png")
            done = self.run_cli("synth", self.exemplar, "-o", out, "--threads", "1", preexec_fn=limit, timeout=60)
            self.assertIn(done.returncode, (0, 5), f"{mebibytes} MiB: {done.stderr}")
            self.assertEqual(os.path.exists(out), done.returncode == 0)
            if os.path.exists(out):
                os.remove(out)
            seen.add(done.returncode)
        self.assertIn(0, seen)

    def test_a_full_disk_keeps_the_old_file(self):
        # A limit on the size of files fails like a full disk does, for any user.
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
        out = self.path("a.png", b"old")
        done = self.run_cli("synth", self.exemplar, "-o", out, preexec_fn=limit)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(pathlib.Path(out).read_bytes(), b"old")
        self.assertEqual(os.listdir(self.dir), ["a.png"])

    @unittest.skipUnless(os.geteuid() == 0, "mounting a small file system needs root")
    def test_a_small_file_system(self):
        with tempfile.TemporaryDirectory() as folder:
            if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "none", folder], capture_output=True).returncode:
                self.skipTest("this machine does not allow mounts")
            try:
                done = self.run_cli("synth", self.exemplar, "-o", folder + "/a.png")
                self.assertEqual(done.returncode, 4, done.stderr)
                self.assertIn("disk is full", done.stderr)
                self.assertEqual(os.listdir(folder), [])
            finally:
                subprocess.run(["umount", folder], check=True)

    @unittest.skipUnless(os.geteuid() == 0, "mounting needs root")
    def test_a_read_only_file_system(self):
        with tempfile.TemporaryDirectory() as folder:
            if subprocess.run(["mount", "-t", "tmpfs", "-o", "ro", "none", folder], capture_output=True).returncode:
                self.skipTest("this machine does not allow mounts")
            try:
                done = self.run_cli("synth", self.exemplar, "-o", folder + "/a.png")
                self.assertEqual(done.returncode, 4, done.stderr)
            finally:
                subprocess.run(["umount", folder], check=True)


if __name__ == "__main__":
    unittest.main()
