// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_weave.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "ramify/compose/light_match.h"
#include "ramify/compose/light_patch.h"
#include "ramify/compose/light_seam.h"
#include "ramify/core/parallel.h"

namespace ramify {
namespace {

constexpr std::size_t kContinued = 6;  // of a place's matches, which the next place may go on from
constexpr int kBatch = 48;           // fragments chosen before the counts of use are brought up to date
constexpr float kVisible = 1e-4f;    // layer strength from which a pixel belongs to a fragment

struct StrandJob {
  int strand = kNone;
  std::vector<int> centres;
  std::vector<PatchFrame> frames;
  std::vector<std::vector<LightMatch>> matches;
  std::vector<std::vector<LightPatch>> patches;  // candidates, then the chosen one alone
  std::vector<LightMatch> chosen;
};

// One strand's light over its bounding box.
struct LaidStrand {
  int x0 = 0, y0 = 0;
  ColorImage value;
  ScalarImage window;
  LabelImage owner;  // position of the fragment in the strand
  VectorImage source;
};

std::vector<int> thick_to_thin(const std::vector<Strand>& strands) {
  std::vector<double> mean;
  for (const Strand& s : strands) mean.push_back(std::accumulate(s.radii.begin(), s.radii.end(), 0.0) / s.count());
  std::vector<int> order(strands.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return mean[a] > mean[b]; });
  return order;
}

bool meets(const PatchBox& box, Size size) {
  return box.x0 < size.width && box.y0 < size.height && box.x0 + box.size > 0 && box.y0 + box.size > 0;
}

StrandJob make_job(const std::vector<Strand>& targets, int strand, Size size, const LightRules& rules) {
  StrandJob job;
  job.strand = strand;
  for (const int t : fragment_centres(targets[strand], rules)) {
    if (meets(patch_box(targets[strand], t, rules), size)) job.centres.push_back(t);
  }
  return job;
}

// Runs body(job, fragment) over all fragments of all jobs on all threads.
template <class Body>
void for_fragments(std::vector<StrandJob>& jobs, const Body& body) {
  std::vector<std::pair<int, int>> all;
  for (int j = 0; j < static_cast<int>(jobs.size()); ++j) {
    for (int i = 0; i < static_cast<int>(jobs[j].centres.size()); ++i) all.emplace_back(j, i);
  }
  parallel_for(static_cast<int>(all.size()), [&](int k) { body(jobs[all[k].first], all[k].second); });
}

// Lets every place go on from the best matches of the place before.
void add_continuations(StrandJob& job, const LightSource& source, const Strand& target, const LightRules& rules, double leave_out) {
  for (std::size_t i = 1; i < job.matches.size(); ++i) {
    std::vector<LightMatch> before = job.matches[i - 1];
    std::stable_sort(before.begin(), before.end(), [](const LightMatch& a, const LightMatch& b) { return a.cost < b.cost; });
    before.resize(std::min(before.size(), kContinued));
    for (const LightMatch& match : before) {
      const auto next = continue_light(source, target, job.centres[i - 1], match, job.centres[i], rules, leave_out);
      if (next) job.matches[i].push_back(*next);
    }
  }
}

void choose_sources(std::vector<StrandJob>& jobs, const LightSource& source, const LightLayer& layer,
                    const std::vector<Strand>& targets, const std::vector<int>& uses, const LightRules& rules,
                    double leave_out, const Rng& rng, const Monitor& monitor) {
  for (StrandJob& job : jobs) {
    const std::size_t n = job.centres.size();
    job.frames.resize(n), job.matches.resize(n), job.patches.resize(n), job.chosen.resize(n);
  }
  for_fragments(jobs, [&](StrandJob& job, int i) {
    monitor.check();
    const Strand& target = targets[job.strand];
    const int t = job.centres[i];
    const Rng own = rng.child("light", (static_cast<std::uint64_t>(job.strand) << 32) + static_cast<std::uint64_t>(t));
    job.frames[i] = patch_frame(target, t, rules);
    job.matches[i] = match_light(source, target, t, uses, rules, leave_out, own);
  });
  parallel_for(static_cast<int>(jobs.size()), [&](int j) { add_continuations(jobs[j], source, targets[jobs[j].strand], rules, leave_out); });
  for_fragments(jobs, [&](StrandJob& job, int i) {
    monitor.check();
    for (const LightMatch& match : job.matches[i]) {
      job.patches[i].push_back(cut_patch(source, layer, job.frames[i], targets[job.strand], match, rules, false));
    }
  });
  parallel_for(static_cast<int>(jobs.size()), [&](int j) {
    StrandJob& job = jobs[j];
    if (job.centres.empty()) return;
    const std::vector<int> chain = choose_chain(job.frames, job.patches, rules);
    for (std::size_t i = 0; i < chain.size(); ++i) job.chosen[i] = job.matches[i][chain[i]];
  });
  for_fragments(jobs, [&](StrandJob& job, int i) {
    job.patches[i] = {cut_patch(source, layer, job.frames[i], targets[job.strand], job.chosen[i], rules, true)};
  });
}

// The part of the canvas a strand's discs cover, empty-valued.
LaidStrand empty_area(const StrandJob& job, Size size) {
  int x0 = size.width, y0 = size.height, x1 = 0, y1 = 0;
  for (const PatchFrame& f : job.frames) {
    x0 = std::min(x0, std::max(0, f.box.x0)), y0 = std::min(y0, std::max(0, f.box.y0));
    x1 = std::max(x1, std::min(size.width, f.box.x0 + f.box.size));
    y1 = std::max(y1, std::min(size.height, f.box.y0 + f.box.size));
  }
  const Size area{x1 - x0, y1 - y0};
  return {x0, y0, ColorImage(area), ScalarImage(area), LabelImage(area, kNone), VectorImage(area)};
}

std::vector<LightSeam> find_seams(const StrandJob& job) {
  std::vector<LightSeam> seams;
  for (std::size_t i = 1; i < job.frames.size(); ++i) {
    seams.push_back(find_seam(job.frames[i - 1], job.patches[i - 1][0], job.frames[i], job.patches[i][0]));
  }
  return seams;
}

// Patches of one strand side by side, each within its seams, then the window over all of them.
LaidStrand lay_strand(const StrandJob& job, Size size) {
  LaidStrand laid = empty_area(job, size);
  ScalarImage window(laid.value.size()), weight(laid.value.size()), strongest(laid.value.size());
  const std::vector<LightSeam> seams = find_seams(job);
  for (std::size_t i = 0; i < job.frames.size(); ++i) {
    const PatchFrame& f = job.frames[i];
    const LightPatch& patch = job.patches[i][0];
    for (int y = std::max(laid.y0, f.box.y0); y < std::min(laid.y0 + window.height(), f.box.y0 + f.box.size); ++y) {
      for (int x = std::max(laid.x0, f.box.x0); x < std::min(laid.x0 + window.width(), f.box.x0 + f.box.size); ++x) {
        const auto k = static_cast<std::size_t>(y - f.box.y0) * f.box.size + (x - f.box.x0);
        if (f.window[k] <= 0.0f) continue;
        double share = 1.0;
        if (i > 0) share *= seams[i - 1].second_share(Vec2(x, y));
        if (i < seams.size()) share *= 1.0 - seams[i].second_share(Vec2(x, y));
        const float w = static_cast<float>(share) + 1e-6f;
        const int u = x - laid.x0, v = y - laid.y0;
        laid.value(u, v) = laid.value(u, v) + w * patch.value[k];
        weight(u, v) += w;
        window(u, v) = std::max(window(u, v), f.window[k]);
        laid.window(u, v) = std::max(laid.window(u, v), f.window[k] * f.fade[k]);
        if (w <= strongest(u, v)) continue;
        strongest(u, v) = w;
        laid.owner(u, v) = static_cast<int>(i);
        laid.source(u, v) = patch.source[k];
      }
    }
  }
  for (std::size_t k = 0; k < weight.pixels().size(); ++k) {
    if (weight.pixels()[k] > 0.0f) laid.value.pixels()[k] = window.pixels()[k] / weight.pixels()[k] * laid.value.pixels()[k];
  }
  return laid;
}

float strength(const Rgb& v) { return std::abs(v.r) + std::abs(v.g) + std::abs(v.b); }

void merge(const LaidStrand& laid, int first_fragment, WovenLight& woven) {
  parallel_for(laid.value.height(), [&](int y) {
    for (int x = 0; x < laid.value.width(); ++x) {
      const Rgb& v = laid.value(x, y);
      const int u = laid.x0 + x, w = laid.y0 + y;
      if (strength(v) <= strength(woven.value(u, w))) continue;
      woven.value(u, w) = v;
      woven.window(u, w) = laid.window(x, y);
      if (strength(v) <= kVisible) continue;
      woven.owner(u, w) = first_fragment + laid.owner(x, y);
      woven.source(u, w) = laid.source(x, y);
    }
  }, 64);
}

}  // namespace

WovenLight weave_light(const LightSource& source, const LightLayer& layer, const std::vector<Strand>& targets, Size size,
                       const LightRules& rules, double leave_out, Rng rng, const Monitor& monitor) {
  WovenLight woven;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  woven.value = ColorImage(size);
  woven.window = ScalarImage(size);
  woven.owner = LabelImage(size, kNone);
  woven.source = VectorImage(size, Eigen::Vector2f(nan, nan));
  std::vector<int> uses(source.spots.size(), 0);
  const std::vector<int> order = thick_to_thin(targets);
  for (std::size_t next = 0; next < order.size();) {
    std::vector<StrandJob> jobs;
    for (std::size_t fragments = 0; next < order.size() && fragments < kBatch; ++next) {
      jobs.push_back(make_job(targets, order[next], size, rules));
      fragments += jobs.back().centres.size();
    }
    choose_sources(jobs, source, layer, targets, uses, rules, leave_out, rng, monitor);
    std::vector<LaidStrand> laid(jobs.size());
    parallel_for(static_cast<int>(jobs.size()), [&](int j) {
      if (!jobs[j].centres.empty()) laid[j] = lay_strand(jobs[j], size);
    });
    for (std::size_t j = 0; j < jobs.size(); ++j) {
      merge(laid[j], woven.fragments, woven);
      woven.fragments += static_cast<int>(jobs[j].centres.size());
      for (const LightMatch& match : jobs[j].chosen) ++uses[match.spot];
    }
    monitor.report(static_cast<double>(next) / static_cast<double>(order.size()));
  }
  return woven;
}

}  // namespace ramify
