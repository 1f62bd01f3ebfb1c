#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares ramify's skeleton statistics with the same figures computed by numpy and scipy (and networkx where it is
installed) from the SWC file alone.

compare_statistics.py PRINT_STATISTICS
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.distance import jensenshannon
from scipy.stats import wasserstein_distance

WIDTH, HEIGHT = 400, 300


def random_swc(seed, path):
    rng = np.random.default_rng(seed)
    xy, radius, parent = [], [], []
    for branch in range(25):
        root = branch == 0 or rng.random() < 0.1
        last = -1 if root else int(rng.integers(len(xy)))
        p = rng.uniform((0, 0), (WIDTH, HEIGHT)) if root else np.array(xy[last])
        r = rng.uniform(1, 5)
        heading = rng.uniform(-3, 3)
        for _ in range(int(rng.integers(5, 120))):
            heading += rng.normal(0, 0.25)
            if last >= 0:
                p = p + rng.uniform(0.5, 2.5) * np.array([np.cos(heading), np.sin(heading)])
            xy.append(tuple(p))
            radius.append(0.4 + 0.98 * (r - 0.4))
            r = radius[-1]
            parent.append(last)
            last = len(xy) - 1
    with open(path, "w") as f:
        f.write(f"# ramify canvas {WIDTH} {HEIGHT}\n")
        for i, (p, r, q) in enumerate(zip(xy, radius, parent)):
            f.write(f"{i + 1} 0 {p[0]!r} {p[1]!r} 0 {r!r} {q + 1 if q >= 0 else -1}\n".replace("np.float64(", "").replace(")", ""))
    return np.array(xy), np.array(radius), np.array(parent)


def resample(p, r, h):
    d = np.r_[0, np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))]
    if d[-1] < 2 * h:
        return None
    t = np.arange(0, d[-1], h)
    return np.c_[np.interp(t, d, p[:, 0]), np.interp(t, d, p[:, 1])], np.interp(t, d, r)


def runs_of(parent):
    kids = [[] for _ in parent]
    for i, p in enumerate(parent):
        if p >= 0:
            kids[p].append(i)
    starts = [(i, None) for i in range(len(parent)) if parent[i] < 0]
    starts += [(k, p) for p in range(len(parent)) for k in kids[p][1:]]
    for start, before in starts:
        run = [start] if before is None else [before, start]
        while kids[run[-1]]:
            run.append(kids[run[-1]][0])
        yield run


def bends(xy, radius, parent, h):
    angles, radii, length = [], [], 0.0
    for run in runs_of(parent):
        fine = resample(xy[run], radius[run], 1.0)
        if fine is None or len(fine[0]) < 2 * h:
            continue
        coarse = resample(gaussian_filter1d(fine[0], 2.0, axis=0, mode="nearest"),
                          gaussian_filter1d(fine[1], 4.0, mode="nearest"), h)
        if coarse is None:
            continue
        e = np.diff(coarse[0], axis=0)
        a = np.diff(np.arctan2(e[:, 1], e[:, 0]))
        angles += list((a + np.pi) % (2 * np.pi) - np.pi)
        radii += list(coarse[1])
        length += h * len(coarse[0])
    return np.array(angles), np.array(radii), length


def crossings(xy, parent):
    edges = [(i, p) for i, p in enumerate(parent) if p >= 0]
    a, b = xy[[e[0] for e in edges]], xy[[e[1] for e in edges]]
    count = 0
    for k in range(len(edges)):
        d1, d2, s = b[k] - a[k], b[k + 1:] - a[k + 1:], a[k + 1:] - a[k]
        den = d1[0] * d2[:, 1] - d1[1] * d2[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (s[:, 0] * d2[:, 1] - s[:, 1] * d2[:, 0]) / den
            u = (s[:, 0] * d1[1] - s[:, 1] * d1[0]) / den
        hit = (0 < t) & (t < 1) & (0 < u) & (u < 1)
        count += sum(not set(edges[k]) & set(edges[k + 1 + j]) for j in np.nonzero(hit)[0])
    return count


def strahler(parent):
    kids = [[] for _ in parent]
    order = [1] * len(parent)
    for i in range(len(parent) - 1, -1, -1):
        if kids[i]:
            top = sorted((order[k] for k in kids[i]), reverse=True)
            order[i] = top[0] + (len(top) > 1 and top[0] == top[1])
        if parent[i] >= 0:
            kids[parent[i]].append(i)
    return order


def box_dimension(xy, radius, parent):
    line = np.zeros((HEIGHT, WIDTH), bool)
    for i, p in enumerate(parent):
        q = xy[i] if p < 0 else xy[p]
        n = int(np.ceil(4 * np.linalg.norm(q - xy[i]))) + 1
        points = xy[i] + (q - xy[i]) * np.arange(n + 1)[:, None] / n
        c = np.floor(points + 0.5).astype(int)
        c = c[(c >= 0).all(1) & (c[:, 0] < WIDTH) & (c[:, 1] < HEIGHT)]
        line[c[:, 1], c[:, 0]] = True
    y, x = np.nonzero(line)
    logs = []
    k = 1
    while 8 << k <= max(WIDTH, HEIGHT):
        if 1 << k >= 2 * radius.min():
            logs.append((-np.log(1 << k), np.log(len(set(zip(x >> k, y >> k))))))
        k += 1
    return np.polyfit(*zip(*logs), 1)[0]


def check(name, ours, theirs, tolerance):
    if not np.allclose(ours, theirs, rtol=tolerance, atol=tolerance):
        sys.exit(f"{name}: ramify says {ours}, numpy says {theirs}")


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for seed in range(6):
            swc = [random_swc(10 * seed + k, folder / f"{k}.swc") for k in range(2)]
            got = json.loads(subprocess.run([program, folder / "0.swc", folder / "1.swc"], check=True, capture_output=True).stdout)
            xy, radius, parent = swc[0]
            h = float(np.clip(4 * np.median(radius), 8, 16))
            angles, radii, length = bends(xy, radius, parent, h)
            check("step", got["step"], h, 1e-9)
            check("number of angles", len(got["angles"]), len(angles), 0)
            check("angles", np.sort(got["angles"]), np.sort(angles), 1e-6)
            check("radii", np.sort(got["radii"]), np.sort(radii), 1e-6)
            check("length", got["length"], length, 1e-9)
            other = bends(*swc[1], h)[0]
            check("earth mover's distance", got["emd"], wasserstein_distance(angles, other), 1e-6)
            low, high = angles.min(), angles.max() + 1e-9
            first = np.histogram(angles, 16, (low, high))[0] / len(angles)
            second = np.histogram(np.clip(other, low, high), 16, (low, high))[0] / len(other)
            check("total variation", got["tv"], 0.5 * np.abs(first - second).sum(), 1e-6)
            check("Jensen-Shannon", got["js"], jensenshannon(first, second, base=2) ** 2, 1e-6)
            check("crossings", got["crossings"], crossings(xy, parent), 0)
            check("strahler", got["strahler"], strahler(parent), 0)
            check("box dimension", got["box"], box_dimension(xy, radius, parent), 1e-2)
            i = np.nonzero(parent >= 0)[0]
            edges = xy[i] - xy[parent[i]]
            mean = (edges[:, 0] + 1j * edges[:, 1]).sum() / np.linalg.norm(edges, axis=1).sum()
            check("heading", [got["heading"], got["direction"]], [abs(mean), np.angle(mean)], 1e-9)
            try:
                import networkx
            except ImportError:
                continue
            graph = networkx.DiGraph((int(p), int(c)) for c, p in enumerate(parent) if p >= 0)
            check("tips", got["tips"], sum(d == 0 for _, d in graph.out_degree()), 0)
            check("furcations", got["furcations"], sum(d > 1 for _, d in graph.out_degree()), 0)
    print("6 pairs of skeletons agree")


if __name__ == "__main__":
    main(sys.argv[1])
