#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""compare_thinning.py PROGRAM: our thinning must give scikit-image's `thin`, pixel for pixel."""
import subprocess
import sys

import numpy as np
from scipy import ndimage
from skimage.morphology import thin


def main(program):
    random = np.random.default_rng(5)
    masks = []
    for trial in range(30):
        size = random.integers(3, 90, 2)
        noise = ndimage.gaussian_filter(random.normal(size=size), random.uniform(0.5, 5))
        masks.append(noise > np.quantile(noise, random.uniform(0.2, 0.8)))
    text = "".join(f"{m.shape[1]} {m.shape[0]}\n" + "\n".join("".join("01"[v] for v in row) for row in m.astype(int)) + "\n"
                   for m in masks)
    rows = subprocess.run([program], input=text, capture_output=True, text=True, check=True).stdout.split()
    differing = 0
    for m in masks:
        ours = np.array([[c == "1" for c in row] for row in rows[:m.shape[0]]])
        del rows[:m.shape[0]]
        differing += int((ours != thin(m)).sum())
    print(f"{len(masks)} masks, {differing} pixels differ")
    return differing != 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
