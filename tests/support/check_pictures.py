# SPDX-License-Identifier: GPL-3.0-or-later
"""check_pictures.py FOLDER: reads what ramify wrote with other libraries and compares with expected.f32.

expected.f32 holds W x H x 4 floats (RGBA, 0..1, whole 8-bit levels). Ends with 1 and a sentence when anything differs.
"""
import struct
import sys
import zlib

import numpy as np
import tifffile
from PIL import Image

W, H = 12, 9


def read_png(path):
    """A PNG decoder of its own: the chunks of the specification and its five filters."""
    data = open(path, "rb").read()
    at, idat, texts = 8, b"", {}
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]
        if kind == b"IHDR":
            width, height, bits, color = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            idat += body
        elif kind == b"iTXt":
            key, rest = body.split(b"\0", 1)
            texts[key.decode()] = rest[4:].decode("utf-8")
        at += 12 + length
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[color]
    step, raw = channels * bits // 8, zlib.decompress(idat)
    stride = width * step
    rows, above = [], bytearray(stride)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = (row[i - step] if i >= step else 0), above[i], (above[i - step] if i >= step else 0)
            p = a + b - c
            paeth = a if abs(p - a) <= abs(p - b) and abs(p - a) <= abs(p - c) else b if abs(p - b) <= abs(p - c) else c
            row[i] = (row[i] + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
        rows.append(bytes(row))
        above = row
    array = np.frombuffer(b"".join(rows), ">u2" if bits == 16 else "u1").reshape(height, width, channels)
    return array / (2 ** bits - 1), texts


def close(what, got, expected, tolerance):
    if got.shape != expected.shape:
        sys.exit(f"{what}: shape {got.shape} instead of {expected.shape}")
    error = np.abs(got.astype(float) - expected).max()
    if not error <= tolerance:
        sys.exit(f"{what}: differs by {error}")


def main(folder):
    expected = np.fromfile(f"{folder}/expected.f32", np.float32).reshape(H, W, 4)
    rgb = expected[..., :3]
    for bits in (8, 16):
        array, texts = read_png(f"{folder}/rgba{bits}.png")
        close(f"PNG {bits}", array, expected, 1e-6)
        if texts != {"ramify-recipe": '{"é": 1}'}:
            sys.exit(f"PNG text: {texts}")
        close(f"TIFF {bits}", tifffile.imread(f"{folder}/rgba{bits}.tif") / (2.0 ** bits - 1), expected, 1e-6)
    close("TIFF float", tifffile.imread(f"{folder}/rgb32.tif"), rgb, 0)
    close("PNG by PIL", np.asarray(Image.open(f"{folder}/rgba8.png")) / 255.0, expected, 1e-6)
    close("JPEG", np.asarray(Image.open(f"{folder}/rgb.jpg")) / 255.0, rgb, 0.06)
    close("WebP", np.asarray(Image.open(f"{folder}/rgb.webp")) / 255.0, rgb, 1e-6)
    close("16-bit labels", read_png(f"{folder}/labels.png")[0][..., 0] * 65535, np.arange(W * H).reshape(H, W) * 600.0, 1e-6)
    close("field", tifffile.imread(f"{folder}/field.tif"), rgb[..., 0] * 9 - 4, 1e-6)


main(sys.argv[1])
