// SPDX-License-Identifier: GPL-3.0-or-later
// compare_planning [RUNS]: plans on the same lattices with ramify, with Boost's dijkstra_shortest_paths on a ready graph,
// with a std::priority_queue, and with scikit-image's MCP (bench/compare_planning.py), in turn, RUNS times each (default 3).
// Prints median processor times and ratios, and the largest relative difference of the costs: a time without it says nothing.
// Lattices: 2048 x 2048 with 8 neighbours and 128^3 with 6, whole weights below 1024 and real weights of the same range.
#include <algorithm>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <queue>
#include <string>
#include <vector>

#include "ramify/core/random.h"
#include "ramify/graph/path_forest.h"
#include "ramify/graph/plan.h"

using namespace ramify;

namespace {

struct Rival {
  std::string name;
  std::function<double()> run;  // seconds of one run
  std::vector<double> seconds;
};

// Processor time: all here run on one thread, and the clock on the wall also counts what else the machine does.
double seconds_of(const auto& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Runs all in turn and prints the median time of each, and the first one's over it.
void compare(const std::string& job, std::vector<Rival> rivals, int runs) {
  std::printf("%s\n", job.c_str());
  for (int run = 0; run < runs; ++run) {
    for (Rival& r : rivals) r.seconds.push_back(r.run());
  }
  for (const Rival& r : rivals) {
    std::printf("  %-44s %7.3f s   ramify / this %.3f\n", r.name.c_str(), median(r.seconds), median(rivals[0].seconds) / median(r.seconds));
  }
}

Lattice make_lattice(int width, int height, int depth, Connectivity connectivity, bool whole) {
  Lattice lattice;
  lattice.width = width;
  lattice.height = height;
  lattice.depth = depth;
  lattice.connectivity = connectivity;
  Rng rng(7);
  WholeWeights w(static_cast<std::size_t>(lattice.count()));
  for (auto& v : w) v = static_cast<std::uint16_t>(1 + rng.below(1023));
  RealWeights real(w.begin(), w.end());
  for (auto& v : real) v += static_cast<float>(rng.uniform(-0.5, 0.5));
  if (whole) {
    lattice.weights = std::move(w);
  } else {
    lattice.weights = std::move(real);
  }
  return lattice;
}

// f(node, neighbour, cost) over all edges out of all nodes, nodes ascending.
template <class F>
void for_each_edge(const Lattice& lattice, F&& f) {
  const auto steps = lattice_steps(lattice.connectivity);
  for (int node = 0; node < lattice.count(); ++node) {
    const auto [x, y, z] = node_place(lattice, node);
    for (int k = 0; k < static_cast<int>(steps.size()); ++k) {
      if (lattice.contains(x + steps[k].dx, y + steps[k].dy, z + steps[k].dz)) {
        f(node, lattice.node(x + steps[k].dx, y + steps[k].dy, z + steps[k].dz), edge_cost(lattice, node, k));
      }
    }
  }
}

struct Cost {
  float cost;
};
using BoostGraph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, Cost, boost::no_property, std::uint32_t, std::uint32_t>;

BoostGraph make_boost_graph(const Lattice& lattice) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
  std::vector<Cost> costs;
  for_each_edge(lattice, [&](int a, int b, double cost) {
    ends.push_back({a, b});
    costs.push_back({static_cast<float>(cost)});
  });
  return BoostGraph(boost::edges_are_sorted, ends.begin(), ends.end(), costs.begin(), lattice.count());
}

std::vector<float> boost_costs(const BoostGraph& graph, int source) {
  std::vector<float> distance(num_vertices(graph));
  std::vector<std::uint32_t> before(num_vertices(graph));
  boost::dijkstra_shortest_paths(graph, source,
                                 boost::weight_map(boost::get(&Cost::cost, graph))
                                     .distance_map(boost::make_iterator_property_map(distance.begin(), get(boost::vertex_index, graph)))
                                     .predecessor_map(boost::make_iterator_property_map(before.begin(), get(boost::vertex_index, graph))));
  return distance;
}

// The partial metric as one would write it first: pairs of 32 bits in one 64-bit key, std::priority_queue.
std::vector<std::uint64_t> queue_pairs(const Lattice& lattice, int source, std::vector<std::uint8_t>& parent) {
  const auto steps = lattice_steps(lattice.connectivity);
  const WholeWeights& weight = std::get<WholeWeights>(lattice.weights);
  std::vector<std::uint64_t> best(weight.size(), ~0ull);
  parent.assign(weight.size(), 255);
  using Item = std::pair<std::uint64_t, std::uint32_t>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  best[source] = 0;
  queue.push({0, source});
  while (!queue.empty()) {
    const auto [key, node] = queue.top();
    queue.pop();
    if (key != best[node]) continue;
    const int x = node % lattice.width, y = node / lattice.width;
    for (std::uint8_t k = 0; k < 8; ++k) {
      const int u = x + steps[k].dx, v = y + steps[k].dy;
      if (u < 0 || v < 0 || u >= lattice.width || v >= lattice.height) continue;
      const std::uint32_t to = static_cast<std::uint32_t>(v * lattice.width + u), both = weight[node] + weight[to];
      const std::uint64_t sum = (key & 0xFFFFFFFFu) + (k < 4 ? both * 128u : (both * 181u)), peak = std::max<std::uint64_t>(key >> 32, both * 128u);
      const std::uint64_t through = (peak << 32) | sum;
      if (through >= best[to]) continue;
      best[to] = through;
      parent[to] = k;
      queue.push({through, to});
    }
  }
  return best;
}

// scikit-image's time on the lattice's weights; its costs are left in `costs`.
double skimage_seconds(const Lattice& lattice, int source, const std::string& folder, std::vector<double>& costs) {
  const std::string in = folder + "/weights.f64", out = folder + "/costs.f64", seconds = folder + "/seconds.txt";
  {
    std::ofstream file(in, std::ios::binary);
    for (int i = 0; i < lattice.count(); ++i) {
      const double w = node_weight(lattice, i);
      file.write(reinterpret_cast<const char*>(&w), sizeof w);
    }
  }
  const std::string command = std::string(RAMIFY_PYTHON) + " " + RAMIFY_BENCH_FOLDER + "/compare_planning.py " + in + " " + out + " " +
                              std::to_string(lattice.width) + " " + std::to_string(lattice.height) + " " +
                              std::to_string(lattice.depth) + " " + std::to_string(source) + " > " + seconds;
  if (std::system(command.c_str()) != 0) {
    std::puts("scikit-image could not be run (Debian package python3-skimage)");
    return std::nan("");
  }
  costs.resize(static_cast<std::size_t>(lattice.count()));
  std::ifstream(out, std::ios::binary).read(reinterpret_cast<char*>(costs.data()), static_cast<std::streamsize>(costs.size() * sizeof(double)));
  double time = 0.0;
  std::ifstream(seconds) >> time;
  return time;
}

template <class Costs>
double largest_difference(const Plan& plan, const Costs& costs) {
  double worst = 0.0;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const double ours = path_cost(plan, static_cast<int>(i));
    worst = std::max(worst, std::abs(ours - costs[i]) / std::max(1e-9, std::abs(ours)));
  }
  return worst;
}

void compare_sums(const std::string& job, const Lattice& lattice, int source, int runs, const std::string& folder) {
  Plan plan;
  std::vector<double> theirs;
  std::vector<float> of_boost;
  const BoostGraph graph = make_boost_graph(lattice);
  compare(job,
          {{"ramify", [&] { return seconds_of([&] { plan = plan_paths(lattice, std::vector<int>{source}); }); }, {}},
           {"boost::dijkstra_shortest_paths, ready graph", [&] { return seconds_of([&] { of_boost = boost_costs(graph, source); }); }, {}},
           {"skimage.graph.MCP_Geometric", [&] { return skimage_seconds(lattice, source, folder, theirs); }, {}}},
          runs);
  std::printf("  largest relative difference: %.1e to Boost (float), %.1e to scikit-image (double)\n", largest_difference(plan, of_boost),
              largest_difference(plan, theirs));
}

void compare_pairs(const Lattice& lattice, int source, int runs) {
  PlanOptions partial;
  partial.metric.metric = Metric::Partial;
  std::vector<std::uint8_t> parent;
  compare("partial metric, 2048 x 2048, 8 neighbours, whole weights",
          {{"ramify, partial", [&] { return seconds_of([&] { plan_paths(lattice, std::vector<int>{source}, partial); }); }, {}},
           {"std::priority_queue of 64-bit pairs", [&] { return seconds_of([&] { queue_pairs(lattice, source, parent); }); }, {}},
           {"ramify, sum", [&] { return seconds_of([&] { plan_paths(lattice, std::vector<int>{source}); }); }, {}}},
          runs);
}

// A fractal dendrite as 001 grows it, endpoints by rejection, on 512 x 512: rounds of more and nearer endpoints, each
// around the whole structure so far. 001 needed 7.55 s for 8930 endpoints (1.8 GHz, 2007).
void grow_fractal(int runs) {
  std::vector<double> seconds;
  int endpoints = 0;
  for (int run = 0; run < runs; ++run) {
    seconds.push_back(seconds_of([&] {
      Lattice lattice;
      lattice.width = lattice.height = 512;
      lattice.connectivity = Connectivity::Plane4;
      lattice.weights = HashedWeights{static_cast<std::uint64_t>(run), 1.0, 10.0, true};
      Rng rng(static_cast<std::uint64_t>(run));
      PathForest forest = make_path_forest(lattice.count());
      PlanOptions within;
      within.max_cost = 900.0;
      Plan plan = plan_paths(lattice, std::vector<int>{lattice.node(256, 256)}, within);
      endpoints = 0;
      double wanted = 12.0;
      for (double distance = 900.0; distance > 4.0; distance /= 2.0, wanted *= 2.4) {
        const std::size_t before = forest.nodes.size();
        for (int tries = 0, placed = 0; placed < wanted && tries < 60 * wanted; ++tries) {
          const int node = rng.below(lattice.count());
          const double cost = path_cost(plan, node);
          if (cost < 0.4 * distance || cost > distance) continue;
          const AddedPath path = add_path(forest, plan, lattice, node);
          placed += path.count > 0;
          endpoints += path.count > 0;
        }
        if (distance / 2.0 <= 4.0) break;  // that was the last round
        plan = reseeded(std::move(plan), lattice, std::span<const int>(forest.nodes).subspan(before), distance / 2.0);
      }
    }));
  }
  std::printf("fractal dendrite, 512 x 512, %d endpoints: %.3f s, 1 / %.0f of 7.55 s\n", endpoints, median(seconds), 7.55 / median(seconds));
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 3;
  const std::string folder = (std::filesystem::temp_directory_path() / "compare_planning").string();
  std::filesystem::create_directories(folder);
  for (const bool whole : {true, false}) {
    const std::string kind = whole ? "whole weights" : "real weights";
    const Lattice plane = make_lattice(2048, 2048, 1, Connectivity::Plane8, whole);
    compare_sums("2048 x 2048, 8 neighbours, " + kind, plane, plane.node(1024, 1024), runs, folder);
    if (whole) compare_pairs(plane, plane.node(1024, 1024), runs);
    const Lattice space = make_lattice(128, 128, 128, Connectivity::Volume6, whole);
    compare_sums("128 x 128 x 128, 6 neighbours, " + kind, space, space.node(64, 64, 64), runs, folder);
  }
  grow_fractal(runs);
  std::filesystem::remove_all(folder);
}
