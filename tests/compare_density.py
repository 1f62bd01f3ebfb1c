#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""compare_density.py PROGRAM KIND: letters painted 600 px high mean what they show (PICTURES 9), in two typefaces.

Measured from the written skeleton and the painted map alone: no node in black, 90 % of the length in white, rank
correlation of map and length over cells of 64 px, white within twice the branch spacing of a branch (0.9 and 0.9 wanted).
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image, ImageDraw
from scipy import ndimage, stats

SIZE = (720, 768)
CELL = 64
SEEDS = 3
LEAST_RANK, LEAST_REACHED = 0.9, 0.9


def slab_r():  # above the skyline of the lightning, below which nothing can grow
    image = Image.new("L", SIZE, 0)
    draw = ImageDraw.Draw(image)
    draw.rectangle((130, 34, 260, 634), fill=255)
    draw.rounded_rectangle((130, 34, 570, 394), 170, fill=255)
    draw.rounded_rectangle((260, 150, 440, 278), 60, fill=0)
    draw.rectangle((130, 34, 260, 394), fill=255)
    draw.polygon(((310, 390), (460, 390), (620, 634), (460, 634)), fill=255)
    return image


def plain_r():  # thinner strokes, an oval bow and a leg that leaves its foot
    image = Image.new("L", SIZE, 0)
    draw = ImageDraw.Draw(image)
    draw.ellipse((150, 34, 590, 374), fill=255)
    draw.ellipse((240, 122, 492, 286), fill=0)
    draw.rectangle((130, 34, 370, 374), fill=255)
    draw.rectangle((236, 122, 370, 286), fill=0)
    draw.rectangle((130, 34, 236, 634), fill=255)
    draw.polygon(((340, 370), (450, 340), (610, 634), (490, 634)), fill=255)
    return image


LETTERS = {"slab": slab_r, "plain": plain_r}


def figures(skeleton, white, spacing):
    nodes = np.array(skeleton["nodes"], float)
    xy, radius, parent = nodes[:, :2], nodes[:, 3], nodes[:, 4].astype(int)
    child = np.flatnonzero(parent >= 0)
    a, b = xy[parent[child]], xy[child]
    length = np.linalg.norm(b - a, axis=1)
    pixel = np.clip(np.rint(xy).astype(int), 0, np.array(SIZE) - 1)
    in_white = white[pixel[:, 1], pixel[:, 0]]
    middle = (a + b) / 2
    rows, columns = white.shape[0] // CELL, white.shape[1] // CELL
    whole = white[:rows * CELL, :columns * CELL].reshape(rows, CELL, columns, CELL).mean((1, 3))
    grown = np.histogram2d(middle[:, 1], middle[:, 0], (rows, columns), ((0, rows * CELL), (0, columns * CELL)), weights=length)[0]
    free = np.ones(white.shape, bool)  # far from every branch: distance to samples of the centre lines, less their radius
    near = np.full(white.shape, np.inf)
    for r in np.unique(np.ceil(radius)):
        free[:] = True
        for t in np.linspace(0, 1, 5):
            chosen = np.ceil(radius[child]) == r
            p = np.rint(a + t * (b - a))[chosen].astype(int)
            p = np.clip(p, 0, np.array(SIZE) - 1)
            free[p[:, 1], p[:, 0]] = False
        if not free.all():
            near = np.minimum(near, ndimage.distance_transform_edt(free) - r)
    return {"black nodes": int((~in_white).sum()),
            "length in white": float(length[in_white[child]].sum() / length.sum()),
            "rank correlation": float(stats.spearmanr(whole.ravel(), grown.ravel())[0]),
            "white reached": float((near[white] <= 2 * spacing).mean())}


def main(program, kind):
    failures = 0
    with tempfile.TemporaryDirectory(prefix="ramify-density-") as folder:
        folder = pathlib.Path(folder)

        def run(*args):
            return subprocess.run([program, *map(str, args)], capture_output=True, text=True, check=True).stdout
        run("exemplar", kind, "-o", folder / "source")
        facts = json.loads(run("info", "--json", folder / "source.ramify.json"))
        spacing = facts["style"]["branch_spacing_px"]
        for letter, paint in LETTERS.items():
            image = paint()
            image.save(folder / "map.png")
            white = np.asarray(image) > 127
            for seed in range(1, SEEDS + 1):
                run("grow", f"builtin:{kind}", "--density", folder / "map.png", "--size", f"{SIZE[0]}x{SIZE[1]}", "--seed", seed,
                    "-o", folder / "grown.json")
                found = figures(json.loads((folder / "grown.json").read_text()), white, spacing)
                good = (found["black nodes"] == 0 and found["length in white"] >= 0.9 and
                        found["rank correlation"] >= LEAST_RANK and found["white reached"] >= LEAST_REACHED)
                failures += not good
                print(f"{kind} {letter} seed {seed} spacing {spacing:.1f} px:", {k: round(v, 3) for k, v in found.items()},
                      "" if good else "FAILED")
    return failures != 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
