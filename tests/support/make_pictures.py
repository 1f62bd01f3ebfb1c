# SPDX-License-Identifier: GPL-3.0-or-later
"""make_pictures.py FOLDER: pictures in kinds that ramify reads but does not write, made by other libraries.

Every 8-bit value is (7 x + 13 y + 50 c) % 256, so that the test can say what it must be.
"""
import sys

import numpy as np
import tifffile
from PIL import Image

W, H = 12, 9


def level(channels):
    y, x, c = np.mgrid[0:H, 0:W, 0:channels]
    return ((7 * x + 13 * y + 50 * c) % 256).astype(np.uint8)


def main(folder):
    rgb, rgba, grey = level(3), level(4), level(1)[..., 0]
    Image.fromarray(grey > 127).save(f"{folder}/bit.png")
    Image.fromarray(rgb).quantize(16).save(f"{folder}/palette.png")
    Image.fromarray(rgb).quantize(16).convert("RGB").save(f"{folder}/palette_as_rgb.png")
    Image.fromarray(level(2), "LA").save(f"{folder}/grey_alpha.png")
    Image.fromarray(rgb).save(f"{folder}/lossless.webp", lossless=True)
    Image.fromarray(rgba, "RGBA").save(f"{folder}/alpha.webp", lossless=True, exact=True)
    Image.fromarray(np.full((16, 16, 4), (0, 0, 0, 0), np.uint8), "CMYK").save(f"{folder}/white_cmyk.jpg", quality=95)
    Image.fromarray(np.full((16, 16, 4), (0, 255, 255, 0), np.uint8), "CMYK").save(f"{folder}/red_cmyk.jpg", quality=95)
    Image.fromarray(rgb).save(f"{folder}/progressive.jpg", quality=90, progressive=True)
    Image.fromarray(rgb).save(f"{folder}/lzw.tif", compression="tiff_lzw")
    tifffile.imwrite(f"{folder}/rgb16.tif", rgb.astype(np.uint16) * 257, photometric="rgb")
    tifffile.imwrite(f"{folder}/big_endian16.tif", rgb.astype(np.uint16) * 257, photometric="rgb", byteorder=">")
    tifffile.imwrite(f"{folder}/bigtiff.tif", rgb, photometric="rgb", bigtiff=True)
    tifffile.imwrite(f"{folder}/tiled.tif", rgb, photometric="rgb", tile=(16, 16))
    tifffile.imwrite(f"{folder}/planar.tif", np.moveaxis(rgb, 2, 0), photometric="rgb", planarconfig="separate")
    tifffile.imwrite(f"{folder}/alpha.tif", rgba, photometric="rgb", extrasamples=["unassalpha"])
    associated = rgba.astype(np.float32) / 255
    associated[..., :3] *= associated[..., 3:]
    tifffile.imwrite(f"{folder}/associated.tif", associated, photometric="rgb", extrasamples=["assocalpha"])
    field = rgb.astype(np.float32) / 255 * 3 - 1
    tifffile.imwrite(f"{folder}/float.tif", field, photometric="rgb")
    tifffile.imwrite(f"{folder}/float_grey.tif", field[..., 0], photometric="minisblack")
    tifffile.imwrite(f"{folder}/double.tif", field.astype(np.float64), photometric="rgb")
    field[2, 3, 1], field[4, 5, 0], field[0, 0, 2] = np.nan, np.inf, -np.inf
    tifffile.imwrite(f"{folder}/not_finite.tif", field, photometric="rgb")
    tifffile.imwrite(f"{folder}/pages.tif", np.stack([rgb, 255 - rgb]), photometric="rgb")
    tifffile.imwrite(f"{folder}/signed.tif", rgb.astype(np.int16), photometric="rgb")
    tifffile.imwrite(f"{folder}/complex.tif", grey.astype(np.complex64))
    Image.fromarray(rgb).save(f"{folder}/gif.png", "GIF")


main(sys.argv[1])
