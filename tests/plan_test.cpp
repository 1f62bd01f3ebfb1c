// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/plan.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "ramify/core/parallel.h"
#include "ramify/core/random.h"
#include "ramify/graph/path_forest.h"
#include "support/random_lattice.h"

using namespace ramify;

namespace {

constexpr Connectivity kAll[] = {Connectivity::Plane4, Connectivity::Plane8, Connectivity::Volume6, Connectivity::Volume26};

// The midpoints of drawn edges in half steps: two edges of a lattice meet between nodes exactly where these coincide.
int crossings(const PathForest& forest, const Lattice& lattice) {
  std::set<std::array<int, 3>> middles;
  int edges = 0;
  for (std::size_t i = 0; i < forest.nodes.size(); ++i) {
    if (forest.parents[i] == kNone) continue;
    const auto a = node_place(lattice, forest.nodes[i]), b = node_place(lattice, forest.nodes[forest.parents[i]]);
    middles.insert({a[0] + b[0], a[1] + b[1], a[2] + b[2]});
    ++edges;
  }
  return edges - static_cast<int>(middles.size());
}

// Dijkstra over pairs with an ordered set, and the parent each node must have: of the neighbours that offer its label
// the one with the lowest label, then the lowest index. Costs are exact in doubles.
struct PairTwin {
  std::vector<std::pair<double, double>> label;  // peak, sum
  std::vector<int> parent;
};

PairTwin partial_twin(const Lattice& lattice, int source) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  PairTwin twin{std::vector<std::pair<double, double>>(static_cast<std::size_t>(lattice.count()), {kFar, kFar}),
                std::vector<int>(static_cast<std::size_t>(lattice.count()), kNone)};
  const int steps = static_cast<int>(lattice_steps(lattice.connectivity).size());
  const auto for_each_offer = [&](int node, const auto& f) {
    const auto [x, y, z] = node_place(lattice, node);
    for (int k = 0; k < steps; ++k) {
      const LatticeStep step = lattice_steps(lattice.connectivity)[k];
      if (!lattice.contains(x + step.dx, y + step.dy, z + step.dz)) continue;
      const double cost = edge_cost(lattice, node, k);
      f(lattice.node(x + step.dx, y + step.dy, z + step.dz),
        std::pair{std::max(twin.label[node].first, cost), twin.label[node].second + cost});
    }
  };
  std::set<std::pair<std::pair<double, double>, int>> front{{{0.0, 0.0}, source}};
  twin.label[source] = {0.0, 0.0};
  while (!front.empty()) {
    const int node = front.begin()->second;
    front.erase(front.begin());
    for_each_offer(node, [&](int to, const std::pair<double, double>& offered) {
      if (offered >= twin.label[to]) return;
      front.erase({twin.label[to], to});
      twin.label[to] = offered;
      front.insert({offered, to});
    });
  }
  for (int node = 0; node < lattice.count(); ++node) {
    for_each_offer(node, [&](int to, const std::pair<double, double>& offered) {
      if (to == source || offered != twin.label[to]) return;
      int& parent = twin.parent[to];
      if (parent == kNone || std::pair{twin.label[node], node} < std::pair{twin.label[parent], parent}) parent = node;
    });
  }
  return twin;
}

}  // namespace

TEST_CASE("the sum of the edges on every path is the cost of its end") {
  Rng rng(1);
  for (int trial = 0; trial < 40; ++trial) {
    const Lattice lattice = random_lattice(rng, kAll[trial % 4]);
    const Metric metric = trial % 3 == 0 ? Metric::Sum : trial % 3 == 1 ? Metric::Partial : Metric::Full;
    PlanOptions options;
    options.metric.metric = metric;
    const Plan plan = plan_paths(lattice, std::vector<int>{random_node(lattice, rng)}, options);
    const auto steps = lattice_steps(lattice.connectivity);
    for (int node = 0; node < lattice.count(); ++node) {
      if (!is_reached(plan, node) || plan.step[node] == kSource) continue;
      const int parent = path_parent(plan, lattice, node);
      REQUIRE(is_allowed(lattice, parent));
      CHECK(path_sum(plan, node) == Approx(path_sum(plan, parent) + edge_cost(lattice, parent, plan.step[node] ^ 1)).epsilon(1e-5));
    }
    CHECK(steps.size() == (trial % 4 == 0 ? 4u : trial % 4 == 1 ? 8u : trial % 4 == 2 ? 6u : 26u));
  }
}

TEST_CASE("no node could be reached cheaper through a neighbour") {
  Rng rng(2);
  for (int trial = 0; trial < 60; ++trial) {
    const Lattice lattice = random_lattice(rng, kAll[trial % 4]);
    PlanOptions options;
    options.metric.metric = trial % 2 ? Metric::Sum : Metric::Power;
    options.metric.power = 3.0;
    const double p = trial % 2 ? 1.0 : 3.0;
    const Plan plan = plan_paths(lattice, std::vector<int>{random_node(lattice, rng), random_node(lattice, rng)}, options);
    const auto steps = lattice_steps(lattice.connectivity);
    for (int node = 0; node < lattice.count(); ++node) {
      if (!is_reached(plan, node)) continue;
      const auto [x, y, z] = node_place(lattice, node);
      for (int k = 0; k < static_cast<int>(steps.size()); ++k) {
        if (!lattice.contains(x + steps[k].dx, y + steps[k].dy, z + steps[k].dz)) continue;
        const int to = lattice.node(x + steps[k].dx, y + steps[k].dy, z + steps[k].dz);
        if (!is_allowed(lattice, to)) continue;
        REQUIRE(is_reached(plan, to));
        const double through = std::pow(std::pow(path_cost(plan, node), p) + std::pow(edge_cost(lattice, node, k), p), 1.0 / p);
        CHECK(path_cost(plan, to) <= through * (1.0 + 1e-5));
      }
    }
  }
}

TEST_CASE("the partial metric's labels and parents are those of a plain search") {
  Rng rng(21);
  for (int trial = 0; trial < 36; ++trial) {
    Lattice lattice;
    lattice.connectivity = trial % 2 ? Connectivity::Plane8 : Connectivity::Volume6;
    lattice.width = 12 + rng.below(40);
    lattice.height = 12 + rng.below(12);
    lattice.depth = trial % 2 ? 1 : 5;
    lattice.diagonal = DiagonalLength::None;
    const int most = trial % 3 == 0   ? 3
                     : trial % 3 == 1 ? 900
                                      : 60000;  // few peaks, some, more than anything is sorted into
    if (trial % 4 < 2) {
      WholeWeights w(static_cast<std::size_t>(lattice.count()));
      for (auto& v : w) v = static_cast<std::uint16_t>(1 + rng.below(most));
      lattice.weights = std::move(w);
    } else {
      RealWeights w(static_cast<std::size_t>(lattice.count()));
      for (auto& v : w) v = static_cast<float>(1 + rng.below(most)) / 64.0f;
      lattice.weights = std::move(w);
    }
    PlanOptions options;
    options.metric.metric = Metric::Partial;
    const int source = random_node(lattice, rng);
    const Plan plan = plan_paths(lattice, std::vector<int>{source}, options);
    const PairTwin twin = partial_twin(lattice, source);
    for (int node = 0; node < lattice.count(); ++node) {
      REQUIRE(path_cost(plan, node) == twin.label[node].first);
      REQUIRE(path_sum(plan, node) == twin.label[node].second);
      REQUIRE(path_parent(plan, lattice, node) == twin.parent[node]);
    }
  }
}

TEST_CASE("more sources touch only what improves and give what planning anew gives") {
  Rng rng(3);
  for (int trial = 0; trial < 60; ++trial) {
    const Lattice lattice = random_lattice(rng, kAll[trial % 4]);
    PlanOptions options;
    options.metric.metric = static_cast<Metric>(trial % 5);
    std::vector<int> sources{random_node(lattice, rng)};
    Plan plan = plan_paths(lattice, sources, options);
    for (int round = 0; round < 3; ++round) {
      std::vector<int> more;
      for (int i = 0; i < 4; ++i) more.push_back(random_node(lattice, rng));
      sources.insert(sources.end(), more.begin(), more.end());
      plan = reseeded(std::move(plan), lattice, more, std::numeric_limits<double>::infinity());
      const Plan anew = plan_paths(lattice, sources, options);
      CHECK(plan.sum == anew.sum);
      CHECK(plan.pair == anew.pair);
      CHECK(plan.power_sum == anew.power_sum);
      CHECK(plan.step == anew.step);
    }
  }
}

TEST_CASE("more sources within a bound give every cost below it") {
  Rng rng(13);
  int within = 0, beyond = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Lattice lattice = random_lattice(rng, kAll[trial % 4]);
    PlanOptions options;
    options.metric.metric = static_cast<Metric>(trial % 5);
    const int first = random_node(lattice, rng);
    std::vector<int> sources{first};
    const bool even = lattice.edge_cost == EdgeCost::Mean && lattice.direction_factor.empty();  // edges cost the same both ways
    const double across = path_cost(plan_paths(lattice, sources, options), random_node(lattice, rng));
    if (!std::isfinite(across)) continue;
    double bound = options.max_cost = 0.9 * across;
    Plan plan = plan_paths(lattice, sources, options);
    for (int round = 0; round < 3; ++round) {
      const std::vector<int> more{random_node(lattice, rng), random_node(lattice, rng)};
      sources.insert(sources.end(), more.begin(), more.end());
      bound *= 0.7;
      plan = reseeded(std::move(plan), lattice, more, bound);
      const Plan whole = plan_paths(lattice, sources, {options.metric, std::numeric_limits<double>::infinity(), {}});
      for (int node = 0; node < lattice.count(); ++node) {
        const double cost = path_cost(whole, node);
        if (cost < bound * (1.0 - 1e-4)) {
          CHECK(path_cost(plan, node) == Approx(cost).epsilon(1e-4));
          CHECK(path_parent(plan, lattice, node) == path_parent(whole, lattice, node));
          ++within;
        } else if (cost > bound * (1.0 + 1e-4) && plan.step[node] != kSource && (options.metric.metric != Metric::Full || even)) {
          CHECK(path_cost(plan, node) > bound * (1.0 - 1e-4));
          ++beyond;
        }
      }
    }
  }
  CHECK(within > 5000);
  CHECK(beyond > 5000);
}

TEST_CASE("truncation and early stop keep what the whole plan says") {
  Rng rng(4);
  for (int trial = 0; trial < 60; ++trial) {
    const Lattice lattice = random_lattice(rng, kAll[trial % 4]);
    PlanOptions options;
    options.metric.metric = static_cast<Metric>(trial % 5);
    const std::vector<int> source{random_node(lattice, rng)};
    const Plan whole = plan_paths(lattice, source, options);
    const std::vector<int> ends{random_node(lattice, rng), random_node(lattice, rng)};
    PlanOptions early = options;
    early.endpoints = ends;
    const Plan stopped = plan_paths(lattice, source, early);
    for (const int end : ends) CHECK(path_cost(stopped, end) == path_cost(whole, end));
    int missing = 0;
    for (int node = 0; node < lattice.count(); ++node) {
      if (is_reached(stopped, node)) CHECK(path_cost(stopped, node) == path_cost(whole, node));
      missing += is_reached(whole, node) && !is_reached(stopped, node);
    }
    CHECK(stopped.stopped_early >= (missing > 0));
    if (stopped.stopped_early) CHECK_THROWS_AS(reseeded(stopped, lattice, ends, 1.0), std::invalid_argument);

    PlanOptions bounded = options;
    bounded.max_cost = 0.5 * path_cost(whole, ends[0]);
    if (!std::isfinite(bounded.max_cost)) continue;
    const Plan near = plan_paths(lattice, source, bounded);
    for (int node = 0; node < lattice.count(); ++node) {
      const double cost = path_cost(whole, node);
      if (std::abs(cost - bounded.max_cost) < 1e-4 * cost || node == source[0]) continue;
      CHECK(is_reached(near, node) == (is_reached(whole, node) && cost < bounded.max_cost));
    }
  }
}

TEST_CASE("every plan is the same for any number of threads and keeps its ties") {
  Rng rng(5);
  const Lattice lattice = random_lattice(rng, Connectivity::Plane8);
  const std::vector<int> source{random_node(lattice, rng)};
  set_thread_count(1);
  const Plan one = plan_paths(lattice, source);
  set_thread_count(3);
  const Plan three = plan_paths(lattice, source);
  set_thread_count(0);
  CHECK(one.step == three.step);
  // On an even lattice all ties: the parent is the neighbour with the lowest cost, then index.
  Lattice even;
  even.width = even.height = 5;
  even.connectivity = Connectivity::Plane4;
  even.weights = WholeWeights(25, 1);
  const Plan plan = plan_paths(even, std::vector<int>{0});
  CHECK(path_parent(plan, even, even.node(3, 3)) == even.node(3, 2));
  CHECK(path_cost(plan, even.node(3, 3)) == 6.0);
}

TEST_CASE("no two drawn paths cross in 1000 random plans") {
  Rng rng(6);
  int aside = 0, blocked = 0, drawn = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const Lattice lattice = random_lattice(rng, trial % 5 == 0 ? Connectivity::Volume26 : Connectivity::Plane8);
    PlanOptions options;
    options.metric.metric = static_cast<Metric>(trial % 5);
    const int sources = 1 + rng.below(3);
    std::vector<int> from, generator(static_cast<std::size_t>(lattice.count()), kNone);
    for (int s = 0; s < sources; ++s) {
      from.push_back(random_node(lattice, rng));
      generator[from.back()] = s;
    }
    PathForest forest = make_path_forest(lattice.count(), trial % 2 ? generator : std::vector<int>());
    Plan plan = plan_paths(lattice, from, options);
    for (int round = 0; round < 2; ++round) {
      for (int i = 0; i < 25; ++i) {
        const AddedPath path = add_path(forest, plan, lattice, random_node(lattice, rng));
        aside += path.aside;
        blocked += path.blocked;
        drawn += path.count > 0;
      }
      plan = reseeded(std::move(plan), lattice, forest.nodes, std::numeric_limits<double>::infinity());
    }
    REQUIRE(crossings(forest, lattice) == 0);
    for (std::size_t i = 0; i < forest.nodes.size(); ++i) REQUIRE(forest.parents[i] < static_cast<int>(i));
    if (trial % 2 == 0) continue;
    for (std::size_t i = 0; i < forest.nodes.size(); ++i) {  // trees of different generators stay apart
      int root = static_cast<int>(i);
      while (forest.parents[root] != kNone) root = forest.parents[root];
      REQUIRE(generator[forest.nodes[root]] != kNone);
    }
  }
  CHECK(aside > 100);  // else the test says nothing about crossings
  CHECK(blocked > 0);
  CHECK(drawn > 10000);
}

TEST_CASE("polylines start where a path joins and end at its endpoint") {
  Lattice lattice;
  lattice.width = lattice.height = 9;
  lattice.connectivity = Connectivity::Plane4;
  lattice.weights = WholeWeights(81, 1);
  const Plan plan = plan_paths(lattice, std::vector<int>{lattice.node(0, 0)});
  PathForest forest = make_path_forest(lattice.count());
  add_path(forest, plan, lattice, lattice.node(8, 0));
  add_path(forest, plan, lattice, lattice.node(4, 0));  // drawn already
  add_path(forest, plan, lattice, lattice.node(8, 3));
  const auto lines = forest_polylines(forest, lattice);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].front() == Vec3(0, 0, 0));
  CHECK(lines[0].back() == Vec3(8, 0, 0));
  CHECK(lines[0].size() == 9);
  CHECK(lines[1].front() == Vec3(8, 0, 0));
  CHECK(lines[1].back() == Vec3(8, 3, 0));
}

TEST_CASE("what a plan cannot use is said in words") {
  Lattice lattice;
  CHECK_THROWS_WITH(plan_paths(lattice, std::vector<int>{0}), Catch::Contains("at least one node"));
  lattice.width = lattice.height = 4;
  CHECK_THROWS_WITH(plan_paths(lattice, std::vector<int>{}), Catch::Contains("at least one source"));
  CHECK_THROWS_WITH(plan_paths(lattice, std::vector<int>{16}), Catch::Contains("source 16"));
  lattice.weights = RealWeights(15, 1.0f);
  CHECK_THROWS_WITH(plan_paths(lattice, std::vector<int>{0}), Catch::Contains("16 nodes, but 15 weights"));
  lattice.weights = RealWeights(16, 1.0f);
  std::get<RealWeights>(lattice.weights)[3] = -1.0f;
  CHECK_THROWS_WITH(plan_paths(lattice, std::vector<int>{3}), Catch::Contains("forbidden"));
  lattice.depth = 2;
  CHECK_THROWS_WITH(plan_paths(lattice, std::vector<int>{0}), Catch::Contains("6 or 26"));
  CHECK_THROWS_AS(node_at(lattice, Vec3(4.0, 0, 0)), InputError);
}

namespace {

struct Link {
  double cost;
  int a, b;
};

// The tree of cheapest edges (Kruskal), as neighbour lists with costs.
std::vector<std::vector<std::pair<int, double>>> cheapest_tree(std::vector<Link> links, int count) {
  std::sort(links.begin(), links.end(), [](const Link& x, const Link& y) { return x.cost < y.cost; });
  std::vector<int> group(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) group[i] = i;
  const auto find = [&](int i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
  };
  std::vector<std::vector<std::pair<int, double>>> tree(group.size());
  for (const Link& link : links) {
    if (find(link.a) == find(link.b)) continue;
    group[find(link.a)] = find(link.b);
    tree[link.a].push_back({link.b, link.cost});
    tree[link.b].push_back({link.a, link.cost});
  }
  return tree;
}

// Who leads back to `root` in a tree.
std::vector<int> rooted(const std::vector<std::vector<std::pair<int, double>>>& tree, int root) {
  std::vector<int> parent(tree.size(), kNone), open{root};
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    for (const auto& [next, cost] : tree[node]) {
      if (next == root || parent[next] != kNone) continue;
      parent[next] = node;
      open.push_back(next);
    }
  }
  return parent;
}

}  // namespace

TEST_CASE("paths by the full metric are the paths in the minimum spanning tree for 10000 pairs") {
  Rng rng(7);
  int pairs = 0;
  for (int trial = 0; trial < 25; ++trial) {
    Lattice lattice;
    lattice.width = 13 + trial;
    lattice.height = 12;
    lattice.weights = random_weights(lattice.count(), rng);  // so all costs of edges differ
    std::vector<Link> links;
    const auto steps = lattice_steps(lattice.connectivity);
    for (int node = 0; node < lattice.count(); ++node) {
      const auto [x, y, z] = node_place(lattice, node);
      for (int k = 0; k < 8; k += 2) {
        if (!lattice.contains(x + steps[k].dx, y + steps[k].dy)) continue;
        const double length = k < 4 ? 1.0 : std::sqrt(2.0);
        links.push_back({edge_cost(lattice, node, k) / length, node, lattice.node(x + steps[k].dx, y + steps[k].dy)});
      }
    }
    const auto tree = cheapest_tree(links, lattice.count());
    PlanOptions options;
    options.metric.metric = Metric::Full;
    const int source = rng.below(lattice.count());
    const Plan plan = plan_paths(lattice, std::vector<int>{source}, options);
    const std::vector<int> parent = rooted(tree, source);
    for (int pair = 0; pair < 400; ++pair, ++pairs) {
      for (int node = rng.below(lattice.count()); node != kNone; node = parent[node]) {
        REQUIRE(path_parent(plan, lattice, node) == parent[node]);
      }
    }
  }
  CHECK(pairs == 10000);
}
