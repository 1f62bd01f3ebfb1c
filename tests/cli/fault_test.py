# SPDX-License-Identifier: GPL-3.0-or-later
"""Every call that writes made to fail in turn (RELIABILITY rows 39 and 40): the old file or the new one, never a third."""
import errno
import os
import pathlib
import shutil
import subprocess
import unittest

from harness import CliTest

SHIM = pathlib.Path(__file__).with_name("fault.c")


@unittest.skipUnless(shutil.which("cc"), "needs a C compiler for the preloaded faults")
class Faults(CliTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.shim = str(cls.small / "fault.so")
        subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", cls.shim, str(SHIM), "-ldl"], check=True)

    @classmethod
    def preloaded(cls, **faults):
        # AddressSanitizer otherwise insists on being the first library of all.
        return {"LD_PRELOAD": cls.shim, "ASAN_OPTIONS": "verify_asan_link_order=0", **faults}

    def conversions(self):
        """Two verbs that end fast: a picture and a skeleton written anew over an old file."""
        return [(self.photo, self.path("a.png", b"old")), (self.exemplar, self.path("a.swc", b"old"))]

    def test_every_call_that_writes_fails_once(self):
        for source, out in self.conversions():
            files = sorted(os.listdir(self.dir))
            for code, says in [(errno.EIO, "error"), (errno.ENOSPC, "disk is full"), (errno.EDQUOT, "disk is full"),
                               (errno.EACCES, "no permission"), (errno.EROFS, "read-only")]:
                failed = 0
                pathlib.Path(out).write_bytes(b"old")
                for at in range(1, 20):
                    done = self.run_cli("convert", source, "-o", out, env=self.preloaded(FAULT_AT=str(at), FAULT_ERRNO=str(code)))
                    self.assertEqual(sorted(os.listdir(self.dir)), files)
                    if done.returncode == 0:
                        break
                    failed += 1
                    self.assertEqual(done.returncode, 4, done.stderr)
                    self.assertIn(says, done.stderr)
                    self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                    self.assertEqual(pathlib.Path(out).read_bytes(), b"old")
                    if code != errno.EIO:
                        break  # the other reasons differ in their sentence only
                self.assertGreaterEqual(failed, 4 if code == errno.EIO else 1, "mkostemp, write, fsync and rename")

    def test_short_and_interrupted_writes_end_in_the_same_bytes(self):
        for source, out in self.conversions():
            self.ok("convert", source, "-o", out)
            plain = self.digest(out)
            self.ok("convert", source, "-o", out, env=self.preloaded(FAULT_WRITES="short"))
            self.assertEqual(self.digest(out), plain)


if __name__ == "__main__":
    unittest.main()
