// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/lattice.h"

#include <cmath>
#include <string>

#include "ramify/core/options.h"
#include "ramify/graph/lattice_hash.h"

namespace ramify {
namespace {

constexpr LatticeStep kPlane[8] = {{1, 0, 0}, {-1, 0, 0},  {0, 1, 0},  {0, -1, 0},
                                   {1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}};
constexpr LatticeStep kVolume[26] = {
    {1, 0, 0},  {-1, 0, 0},   {0, 1, 0},   {0, -1, 0},  {0, 0, 1},   {0, 0, -1},                           // axes
    {1, 1, 0},  {-1, -1, 0},  {1, -1, 0},  {-1, 1, 0},  {1, 0, 1},   {-1, 0, -1},                          // faces
    {1, 0, -1}, {-1, 0, 1},   {0, 1, 1},   {0, -1, -1}, {0, 1, -1},  {0, -1, 1},                           //
    {1, 1, 1},  {-1, -1, -1}, {1, 1, -1},  {-1, -1, 1}, {1, -1, 1},  {-1, 1, -1}, {-1, 1, 1}, {1, -1, -1}};  // body

double length_of(const Lattice& lattice, const LatticeStep& s) {
  return lattice.diagonal == DiagonalLength::None ? 1.0 : std::sqrt(s.dx * s.dx + s.dy * s.dy + s.dz * s.dz);
}

void check_array(std::size_t entries, const Lattice& lattice, const char* what) {
  if (entries == static_cast<std::size_t>(lattice.count())) return;
  throw InputError("", std::string("the lattice has ") + std::to_string(lattice.count()) + " nodes, but " +
                           std::to_string(entries) + " " + what + ": give one a node");
}

struct WeightOf {
  int node;
  double operator()(const HashedWeights& w) const { return w.base + w.spread * lattice_hash01(w.seed, node); }
  double operator()(const WholeWeights& w) const { return w[node]; }
  double operator()(const RealWeights& w) const { return w[node]; }
};

}  // namespace

std::span<const LatticeStep> lattice_steps(Connectivity connectivity) {
  switch (connectivity) {
    case Connectivity::Plane4: return {kPlane, 4};
    case Connectivity::Plane8: return {kPlane, 8};
    case Connectivity::Volume6: return {kVolume, 6};
    case Connectivity::Volume26: break;
  }
  return {kVolume, 26};
}

std::array<int, 3> node_place(const Lattice& lattice, int node) {
  const int row = node / lattice.width;
  return {node % lattice.width, row % lattice.height, row / lattice.height};
}

Vec3 node_position(const Lattice& lattice, int node) {
  const auto [x, y, z] = node_place(lattice, node);
  return Vec3(x, y, z);
}

int node_at(const Lattice& lattice, const Vec3& p) {
  const Vec3 r(std::round(p.x()), std::round(p.y()), std::round(p.z()));
  const bool inside = r.minCoeff() >= 0.0 && r.x() < lattice.width && r.y() < lattice.height && r.z() < lattice.depth;
  if (!inside) {
    throw InputError("", "the point " + number_text(p.x()) + "," + number_text(p.y()) + "," + number_text(p.z()) +
                             " lies outside the lattice of " + std::to_string(lattice.width) + " x " +
                             std::to_string(lattice.height) + " x " + std::to_string(lattice.depth) + " nodes");
  }
  return lattice.node(static_cast<int>(r.x()), static_cast<int>(r.y()), static_cast<int>(r.z()));
}

bool is_allowed(const Lattice& lattice, int node) {
  if (!lattice.allowed.empty() && !lattice.allowed[node]) return false;
  const double weight = node_weight(lattice, node);
  return weight > 0.0 && std::isfinite(weight);
}

double node_weight(const Lattice& lattice, int node) { return std::visit(WeightOf{node}, lattice.weights); }

double edge_cost(const Lattice& lattice, int node, int step) {
  const LatticeStep s = lattice_steps(lattice.connectivity)[step];
  const int to = node + s.dx + lattice.width * (s.dy + lattice.height * s.dz);
  double cost = 0.0;
  const HashedWeights* hashed = std::get_if<HashedWeights>(&lattice.weights);
  if (hashed && hashed->per_edge) {
    cost = hashed->base + hashed->spread * edge_hash01(hashed->seed, node, to);
  } else if (lattice.edge_cost == EdgeCost::Mean) {
    cost = 0.5 * (node_weight(lattice, node) + node_weight(lattice, to));
  } else {
    cost = node_weight(lattice, to);
  }
  return cost * length_of(lattice, s) * (lattice.direction_factor.empty() ? 1.0 : lattice.direction_factor[step]);
}

void check_lattice(const Lattice& lattice) {
  if (lattice.width < 1 || lattice.height < 1 || lattice.depth < 1) throw InputError("", "a lattice needs at least one node along every axis");
  const double nodes = static_cast<double>(lattice.width) * lattice.height * lattice.depth;
  if (nodes > 2147483647.0) throw LimitError("a lattice of " + number_text(nodes) + " nodes is too large: at most 2147483647");
  const bool plane = lattice.connectivity == Connectivity::Plane4 || lattice.connectivity == Connectivity::Plane8;
  if (plane && lattice.depth != 1) throw InputError("", "a lattice with depth needs 6 or 26 neighbours, not 4 or 8");
  if (!lattice.allowed.empty()) check_array(lattice.allowed.size(), lattice, "entries in the mask");
  if (const auto* w = std::get_if<WholeWeights>(&lattice.weights)) check_array(w->size(), lattice, "weights");
  if (const auto* w = std::get_if<RealWeights>(&lattice.weights)) check_array(w->size(), lattice, "weights");
  if (const auto* w = std::get_if<HashedWeights>(&lattice.weights)) {
    if (!(w->base > 0.0 && w->base <= 1e9)) throw OptionError("weight-base", number_text(w->base), "must lie above 0, up to 1e9");
    if (!(w->spread >= 0.0 && w->spread <= 1e9)) throw OptionError("weight-spread", number_text(w->spread), "must lie in 0 .. 1e9");
  }
  const std::size_t steps = lattice_steps(lattice.connectivity).size(), factors = lattice.direction_factor.size();
  if (factors != 0 && factors != steps) throw InputError("", "direction factors: give one for each of the " + std::to_string(steps) + " steps");
  for (const double f : lattice.direction_factor) {
    if (!(f >= 1e-3 && f <= 1e3)) throw InputError("", "direction factor " + number_text(f) + ": must lie in 0.001 .. 1000");
  }
}

}  // namespace ramify
