// SPDX-License-Identifier: GPL-3.0-or-later
// What the verbs `dendrite` and `stylize` are told, turned into lattices, generators and endpoints.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/preset.h"
#include "ramify/graph/lattice.h"
#include "ramify/growth/aggregation.h"
#include "ramify/growth/cost_lines.h"
#include "ramify/growth/dendrite.h"
#include "ramify/growth/importance.h"
#include "ramify/growth/picture_tree.h"
#include "ramify/growth/stylization.h"
#include "ramify/image/image_io.h"
#include "ramify/recipe/figure.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

enum class Neighbours { Four, Eight };

struct LatticeOptions {
  double pitch = 1.0;           // px from node to node
  Neighbours connectivity = Neighbours::Eight;
  double roughness = 10.0;      // r of W = 1 + r u
  bool edge_weights = false;    // every edge its own random weight, as in paper 001, instead of the mean of its nodes
  EdgeCost edge_cost = EdgeCost::Mean;
  DiagonalLength diagonal = DiagonalLength::Geometric;
  double upward = 1.0;          // steps up, away from the root, cost so many times as much
  double sideways = 1.0;        // steps to the side
};
std::vector<OptionField> describe(LatticeOptions& options);

// What becomes of a grown dendrite.
enum class DendriteLines {
  Paths,     // its paths
  Distance,  // lines of equal distance from it
  Cells,     // outlines of what is nearest to each generator; the paths do not matter
};

struct DendriteRequest {
  std::string size;             // "WIDTHxHEIGHT" px; empty = that of the mask or the weights, else 512x512
  std::string mask;             // picture: white = paths may run here; empty = everywhere
  FigureSourceOptions letters;  // text instead of a mask: one graph for every letter
  std::string node_weights;     // float TIFF, one weight a node: the lattice is as large, the canvas pitch times larger
  std::string roots;            // "x,y x,y …" px; or
  std::string generator;        // a picture (white = generator), a drawing (.svg: its lines) or a skeleton; or neither
  std::string endpoints;        // .csv of x,y in px, or a picture with a white dot for each; empty = at random
  LatticeOptions lattice;
  DendriteOptions grow;
  DendriteThickness thickness;
  DendriteLines lines = DendriteLines::Paths;
  CostLineOptions cost_lines;
  AggregationOptions aggregate{0, WalkerLaunch::Circle};  // walkers instead of paths, when there are any
  LoadLimits limits;
};
std::vector<OptionField> describe(DendriteRequest& request);
const std::vector<Preset>& dendrite_presets();

// Throws OptionError for options that would have no effect together.
void check_dendrite(const DendriteRequest& request);

// Walkers on the request's canvas. Throws as grow_aggregate.
Skeleton grow_walkers(const DendriteRequest& request, std::uint64_t seed, const Monitor& monitor);

// The lines that the request wants of a dendrite grown from the target.
Skeleton dendrite_lines(const DendriteRequest& request, const DendriteTarget& target, const Dendrite& dendrite, const Monitor& monitor);

// Reads and checks everything. Without roots or generator: the middle of every connected piece that may be entered; the
// middle of the top for lightning; the whole bottom for moss. Throws InputError, OptionError, LimitError.
DendriteTarget load_dendrite(const DendriteRequest& request, std::uint64_t seed, const Monitor& monitor);

// The files a request reads.
std::vector<std::string> input_files(const DendriteRequest& request);

struct StylizeRequest {
  std::string picture;          // may be empty for a tree that hides nothing
  std::string mask;             // white = paths may run here; empty = everywhere
  std::string root;             // "x,y" px; empty = on a main line (stylization.h), for trees the middle of the bottom
  std::string size;             // "WIDTHxHEIGHT" px of a tree without a picture; empty = 900x1100
  double scale = 0.0;           // of the picture, before planning; 0 = small ones so that the longer side has 1200 px
  bool tree = false;            // a painted tree instead of a drawing by one dendrite
  int layers = 1;               // trees on one trunk, to be painted over one another
  ImportanceOptions importance;
  StylizeOptions stylize;
  ImportanceThickness thickness;
  PictureTreeOptions tree_options;
  LoadLimits limits;
};
std::vector<OptionField> describe(StylizeRequest& request);
const std::vector<Preset>& stylize_presets();
std::vector<std::string> input_files(const StylizeRequest& request);

struct StylizedPicture {
  ScalarImage importance;       // empty for a tree without a picture
  Lattice lattice;              // that the paths ran on; of a tree's last round
  Structure structure;          // the drawing's, or the first tree's
  StippleOptions stipples;      // drawings: what set the endpoints, with
  double threshold = 0.0;       // this cost between them; 0 for trees
  std::vector<int> roots, endpoints;  // nodes
  std::vector<Skeleton> layers; // px of the scaled picture; one, but for trees with several layers
};
StylizedPicture stylize_picture(const StylizeRequest& request, std::uint64_t seed, const Monitor& monitor);

// Intermediates for --debug-dir: weights.tiff and cost.tiff (float, one value a node; forbidden and unreached nodes are
// NaN-free: -1) and endpoints.csv (x,y in px).
void save_lattice_fields(const std::string& folder, const Lattice& lattice, const std::vector<int>& sources,
                         const MetricOptions& metric, const Monitor& monitor);
void save_endpoints(const std::string& folder, const Lattice& lattice, const std::vector<int>& endpoints, double pitch);

}  // namespace ramify
