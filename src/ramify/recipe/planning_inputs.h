// SPDX-License-Identifier: GPL-3.0-or-later
// Points, masks and generators from files, as nodes of a lattice.
#pragma once

#include <string>
#include <vector>

#include "ramify/graph/lattice.h"
#include "ramify/image/image_io.h"

namespace ramify {

// The node whose cell of `pitch` px holds the point; OptionError naming `option` when it lies outside.
int node_of_point(const Lattice& lattice, const Vec2& point, double pitch, const std::string& option);
Vec2 point_of_node(const Lattice& lattice, int node, double pitch);

// x,y in px, one point a line, separated by commas, semicolons, tabs or blanks; empty lines, lines that start with # and
// one line of headings are skipped. Throws InputError naming the line.
std::vector<Vec2> read_points(const std::string& path);

// The centres of a picture's white dots (8-connected), in reading order.
std::vector<Vec2> read_dots(const std::string& path, const LoadLimits& limits);

// 1 for every node whose cell's middle is white in the picture, else 0.
std::vector<std::uint8_t> nodes_of_mask(const Mask& mask, const Lattice& lattice, double pitch);

// Nodes under a white area, a drawing's lines or a skeleton's branches. Throws InputError when there is none.
std::vector<int> read_generator(const std::string& path, const Lattice& lattice, double pitch, const LoadLimits& limits);

// The node nearest to the middle of every connected piece of allowed nodes, in reading order.
std::vector<int> middles_of_pieces(const Lattice& lattice);

}  // namespace ramify
