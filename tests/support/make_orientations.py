# SPDX-License-Identifier: GPL-3.0-or-later
"""make_orientations.py FOLDER: one picture in the eight Exif orientations, and how Pillow turns each upright."""
import sys

import numpy as np
import tifffile
from PIL import Image, ImageOps

folder = sys.argv[1]
y, x, c = np.mgrid[0:5, 0:8, 0:4]
pixels = ((31 * x + 17 * y + 50 * c) % 256).astype(np.uint8)
for orientation in range(1, 9):
    picture = Image.fromarray(pixels, "RGBA")
    exif = Image.Exif()
    exif[0x0112] = orientation
    picture.save(f"{folder}/{orientation}.png", exif=exif)
    picture.save(f"{folder}/{orientation}.webp", exif=exif, lossless=True, exact=True)
    tifffile.imwrite(f"{folder}/{orientation}.tif", pixels, photometric="rgb", extrasamples=["unassalpha"],
                     extratags=[(274, "H", 1, orientation, True)])
    smooth = picture.convert("RGB").resize((64, 40), Image.BICUBIC)
    smooth.save(f"{folder}/{orientation}.jpg", exif=exif, quality=95, subsampling=0)
    ImageOps.exif_transpose(Image.open(f"{folder}/{orientation}.jpg")).save(f"{folder}/{orientation}_jpg_upright.png")
    ImageOps.exif_transpose(Image.open(f"{folder}/{orientation}.png")).save(f"{folder}/{orientation}_upright.png", exif=b"")
