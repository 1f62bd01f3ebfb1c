#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""compare_planning.py WEIGHTS COSTS WIDTH HEIGHT DEPTH SOURCE: what scikit-image takes for one plan, in seconds of processor time.

WEIGHTS and COSTS are raw doubles, x fastest. Only find_costs is timed: neither reading nor starting Python.
"""
import sys
import time

import numpy as np
from skimage.graph import MCP_Geometric

weights_file, costs_file = sys.argv[1:3]
width, height, depth, source = map(int, sys.argv[3:])
shape = (height, width) if depth == 1 else (depth, height, width)
weights = np.fromfile(weights_file).reshape(shape)
search = MCP_Geometric(weights, fully_connected=depth == 1)
start = time.process_time()
costs, _ = search.find_costs([np.unravel_index(source, shape)])
print(time.process_time() - start)
np.asarray(costs).tofile(costs_file)
