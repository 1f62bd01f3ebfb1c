// SPDX-License-Identifier: GPL-3.0-or-later
// plan_memory: the peak memory that a plan needs beyond its lattice, queue included, in bytes a node. One source in the
// middle, whole weights 1 .. 1000. Each plan runs in a process of its own, for peaks only rise.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <vector>

#include "ramify/core/random.h"
#include "ramify/graph/plan.h"

using namespace ramify;

namespace {

struct Job {
  const char* name;
  int width, height, depth;
  Connectivity connectivity;
};

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

// A small plan first: what of the program's code is loaded then is not counted.
void touch_code(const PlanOptions& options) {
  Lattice lattice;
  lattice.width = lattice.height = 16;
  lattice.weights = WholeWeights(256, 3);
  plan_paths(lattice, std::vector<int>{0}, options);
}

double bytes_per_node(const Job& job, Metric metric) {
  Lattice lattice;
  lattice.width = job.width;
  lattice.height = job.height;
  lattice.depth = job.depth;
  lattice.connectivity = job.connectivity;
  Rng rng(7);
  WholeWeights weights(static_cast<std::size_t>(lattice.count()));
  for (auto& w : weights) w = static_cast<std::uint16_t>(1 + rng.below(1000));
  lattice.weights = std::move(weights);
  PlanOptions options;
  options.metric.metric = metric;
  const std::vector<int> source{lattice.node(job.width / 2, job.height / 2, job.depth / 2)};
  touch_code(options);
  const double before = peak_bytes();
  const Plan plan = plan_paths(lattice, source, options);
  return is_reached(plan, 0) ? (peak_bytes() - before) / lattice.count() : -1.0;
}

}  // namespace

int main() {
  constexpr Job kJobs[] = {{"1024^2, 8 neighbours", 1024, 1024, 1, Connectivity::Plane8},
                           {"2048^2, 8 neighbours", 2048, 2048, 1, Connectivity::Plane8},
                           {"4096^2, 8 neighbours", 4096, 4096, 1, Connectivity::Plane8},
                           {"8192^2, 8 neighbours", 8192, 8192, 1, Connectivity::Plane8},
                           {"128^3, 6 neighbours", 128, 128, 128, Connectivity::Volume6}};
  std::printf("%-24s %8s %8s   bytes a node\n", "", "sum", "partial");
  for (const Job& job : kJobs) {
    std::printf("%-24s", job.name);
    for (const Metric metric : {Metric::Sum, Metric::Partial}) {
      std::fflush(stdout);
      const pid_t child = fork();
      if (child < 0) return 1;
      if (child == 0) {
        std::printf(" %8.2f", bytes_per_node(job, metric));
        std::fflush(stdout);
        _exit(0);
      }
      int status = 0;
      if (waitpid(child, &status, 0) < 0 || status != 0) return 1;
    }
    std::printf("\n");
  }
  return 0;
}
