#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""compare_plan.py PROGRAM: what our plans cost must be what scikit-image, networkx and scipy find on the same weights.

Sum: MCP_Geometric and MCP of scikit-image, in the plane and in space, with several sources and forbidden nodes. Whole
weights without lengths of diagonals: to the last digit; otherwise 1e-5. Power: networkx's Dijkstra on costs^p. Full: the
peak on the path within scipy's minimum spanning tree.
"""
import subprocess
import sys

import networkx as nx
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree
from skimage.graph import MCP, MCP_Geometric

random = np.random.default_rng(11)


def ours(program, weights, neighbors, edge, diagonal, kind, sources, metric="sum", power=4):
    depth, height, width = weights.shape
    text = f"{width} {height} {depth} {neighbors} {edge} {diagonal} {kind}\n"
    text += " ".join(f"{w:.9g}" for w in weights.ravel()) + f"\n{len(sources)} " + " ".join(map(str, sources)) + "\n"
    out = subprocess.run([program, metric, str(power), "1000"], input=text, capture_output=True, text=True, check=True)
    return np.array(out.stdout.split(), float).reshape(weights.shape)


def theirs(weights, neighbors, edge, diagonal, sources):
    costs = np.where(weights > 0, weights.astype(float), -1.0)
    if weights.shape[0] == 1:
        costs = costs[0]
    kind = MCP_Geometric if edge == "mean" and diagonal == "geometric" else MCP
    search = kind(costs, fully_connected=neighbors in (8, 26))
    found, _ = search.find_costs([np.unravel_index(s, costs.shape) for s in sources])
    return found.reshape(weights.shape)


def random_weights(shape, kind, forbidden):
    whole = random.integers(1, 1024, shape)
    weights = whole.astype(float) if kind == "whole" else random.uniform(0.02, 11.0, shape).astype(np.float32)
    return np.where(random.uniform(size=shape) < forbidden, 0.0, weights)


def differ(a, b, tolerance):
    reached = np.isfinite(b)
    if (np.isfinite(a) != reached).any():
        return np.inf
    error = np.abs(a[reached] - b[reached]) / np.maximum(np.abs(b[reached]), 1e-12)
    return 0.0 if error.max() <= tolerance else error.max()


def check_sums(program):
    worst = 0.0
    for trial in range(24):
        space = trial % 2
        shape = (11, 13, 17) if space else (1, 60 + trial, 83)
        kind = ("whole", "real")[trial // 2 % 2]
        weights = random_weights(shape, kind, 0.2 if trial % 3 == 0 else 0.0)
        sources = [int(s) for s in random.choice(np.flatnonzero(weights), 1 + trial % 3, replace=False)]
        for neighbors in ((6, 26) if space else (4, 8)):
            for edge, diagonal in (("mean", "geometric"), ("target", "none")):
                exact = kind == "whole" and (edge == "target" or neighbors in (4, 6))
                error = differ(ours(program, weights, neighbors, edge, diagonal, kind, sources),
                               theirs(weights, neighbors, edge, diagonal, sources), 0.0 if exact else 1e-5)
                if error:
                    print(f"trial {trial}, {neighbors} neighbours, {edge}, {kind}: off by {error:.2g}")
                worst = max(worst, error)
    return worst


def check_hashed(program):
    text = "90 70 1 8 mean geometric hashed 42 1 10\n1 3000\n"
    rows = np.array(subprocess.run([program, "sum", "4", "1000"], input=text, capture_output=True, text=True,
                                   check=True).stdout.split(), float)
    weights, costs = rows[:6300].reshape(1, 70, 90), rows[6300:].reshape(1, 70, 90)
    if weights.min() < 1 or weights.max() > 11 or abs(weights.mean() - 6) > 0.15:
        return np.inf
    return differ(costs, theirs(weights, 8, "mean", "geometric", [3000]), 1e-5)


def lattice_edges(weights):
    """All edges of an 8-connected lattice: ends, cost without length, length."""
    height, width = weights.shape
    index = np.arange(height * width).reshape(height, width)
    for dy, dx in ((0, 1), (1, 0), (1, 1), (1, -1)):
        a = index[: height - dy, max(0, -dx): width - max(0, dx)].ravel()
        b = a + dy * width + dx
        yield a, b, (weights.ravel()[a] + weights.ravel()[b]) / 2, np.full(len(a), np.hypot(dy, dx))


def check_power(program):
    weights = random_weights((1, 30, 40), "real", 0.0)
    graph = nx.Graph()
    for a, b, cost, length in lattice_edges(weights[0]):
        graph.add_weighted_edges_from(zip(a, b, (cost * length) ** 5))
    found = nx.single_source_dijkstra_path_length(graph, 77)
    expected = np.array([found[i] for i in range(1200)]).reshape(weights.shape) ** 0.2
    return differ(ours(program, weights, 8, "mean", "geometric", "real", [77], "power", 5), expected, 1e-5)


def check_full(program):
    weights = random_weights((1, 50, 60), "real", 0.0)
    a, b, cost, _ = (np.concatenate(part) for part in zip(*lattice_edges(weights[0])))
    tree = minimum_spanning_tree(coo_matrix((cost, (a, b)), shape=(3000, 3000)).tocsr())
    tree = (tree + tree.T).tocsr()
    order, before = breadth_first_order(tree, 1234)
    peak = np.zeros(3000)
    for node in order[1:]:
        peak[node] = max(peak[before[node]], tree[before[node], node])
    ours_full = ours(program, weights, 8, "mean", "geometric", "real", [1234], "full")
    ours_partial = ours(program, weights, 8, "mean", "geometric", "real", [1234], "partial")
    expected = peak.reshape(weights.shape)
    return max(differ(ours_full, expected, 1e-5), differ(ours_partial, expected, 1e-5))


def main(program):
    errors = {check.__name__: check(program) for check in (check_sums, check_hashed, check_power, check_full)}
    print(errors)
    return any(errors.values())


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
