# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the ramify program for the tests of its edge. RAMIFY_BIN names it; every test gets a folder of its own."""
import hashlib
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib

BIN = os.environ["RAMIFY_BIN"]
SANITIZED = b"__asan_init" in pathlib.Path(BIN).read_bytes()  # AddressSanitizer: 16 TB of address space, more memory and time


def png(width, height, pixel=lambda x, y: (128, 128, 128), claim=None):
    """Bytes of an 8-bit RGB PNG; `claim` puts another size into its header."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    w, h = claim or (width, height)
    rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(width)) for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", w, h, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class CliTest(unittest.TestCase):
    small = None  # folder with a small synthetic exemplar, made once

    @classmethod
    def setUpClass(cls):
        cls.small = pathlib.Path(tempfile.mkdtemp(prefix="ramify-cli-"))
        done = subprocess.run([BIN, "exemplar", "crack", "--size", "240x180", "-o", str(cls.small / "crack")],
                              capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stderr
        cls.exemplar = str(cls.small / "crack.ramify.json")
        cls.photo = str(cls.small / "crack.png")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.small)

    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="ramify-cli-"))

    def tearDown(self):
        shutil.rmtree(self.dir)

    def path(self, name, content=None):
        path = self.dir / name
        if content is not None:
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return str(path)

    def run_cli(self, *args, timeout=120, cwd=None, env=None, prefix=(), **kwargs):
        environment = dict(os.environ, **(env or {}))
        return subprocess.run([*prefix, BIN, *map(str, args)], capture_output=True, text=True, errors="replace",
                              timeout=timeout, cwd=cwd or self.dir, env=environment, **kwargs)

    def ok(self, *args, **kwargs):
        done = self.run_cli(*args, **kwargs)
        self.assertEqual(done.returncode, 0, f"{args}\n{done.stderr}")
        return done

    def fails(self, code, says, *args, **kwargs):
        """Ends with `code`, says every word of `says` in one short line, and leaves no new file."""
        before = sorted(os.listdir(self.dir))
        done = self.run_cli(*args, **kwargs)
        self.assertEqual(done.returncode, code, f"{args}\n{done.stdout}\n{done.stderr}")
        for word in [says] if isinstance(says, str) else says:
            self.assertIn(word, done.stderr)
        lines = [line for line in done.stderr.splitlines() if not line.startswith("note:")]
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertEqual(sorted(os.listdir(self.dir)), before)
        return done

    @staticmethod
    def digest(path):
        return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()
