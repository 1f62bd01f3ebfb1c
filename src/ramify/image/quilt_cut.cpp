// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/quilt_cut.h"

#include <maxflow.h>

#include <algorithm>
#include <cmath>
#include <new>

namespace ramify {
namespace {

using Graph = maxflow::Graph<float, float, float>;

// maxflow calls this when memory is short, and would end the program if it came back.
[[noreturn]] void no_memory(const char*) { throw std::bad_alloc(); }

constexpr float kUnfilledCost = 1e4f;  // leaving a pixel empty
constexpr float kImpossible = 1e6f;    // showing what the photo does not hold
constexpr float kContrast = 0.04f;     // sRGB; seams hide where the picture is livelier than this

float norm(const Rgb& a) { return std::sqrt(a.r * a.r + a.g * a.g + a.b * a.b); }

// What a label shows at a pixel; label kNone shows the known canvas outside the hole.
class View {
 public:
  View(const QuiltJob& job, const Quilt& quilt) : job_(job), quilt_(quilt) {}

  const Rgb* color(int label, int x, int y) const {
    if (label == kNone) return job_.hole(x, y) ? nullptr : &job_.canvas(x, y);
    const QuiltPatch& p = quilt_.patches[label];
    const int u = p.source_x(x), v = p.source_y(y);
    return job_.source.contains(u, v) ? &job_.source(u, v) : nullptr;
  }

  float data(int label, int x, int y) const {
    if (label == kNone) return kUnfilledCost;
    const QuiltPatch& p = quilt_.patches[label];
    const int u = p.source_x(x), v = p.source_y(y);
    if (!job_.source.contains(u, v)) return kImpossible;
    return job_.forbidden(u, v) ? kForbiddenPixel : 0.0f;
  }

  bool precious(int label, int x, int y) const {
    if (label == kNone || job_.precious.empty()) return false;
    const QuiltPatch& p = quilt_.patches[label];
    const int u = p.source_x(x), v = p.source_y(y);
    return job_.precious.contains(u, v) && job_.precious(u, v);
  }

 private:
  const QuiltJob& job_;
  const Quilt& quilt_;
};

// Kwatra's seam cost between two pictures a and b on the edge p-q, weighed by the liveliness of both. Pixels that a
// picture lacks are null.
float seam(const Rgb* ap, const Rgb* bp, const Rgb* aq, const Rgb* bq, float dearness) {
  float error = 0.0f, lively = 0.0f, step = 0.0f;
  const bool at_p = ap && bp, at_q = aq && bq;
  if (!at_p && !at_q) return 1.0f;
  if (at_p) error += norm(*ap - *bp);
  if (at_q) error += norm(*aq - *bq);
  if (at_p != at_q) error *= 2.0f;
  if (ap && aq) lively += norm(*ap - *aq);
  if (bp && bq) lively += norm(*bp - *bq);
  if (at_p && at_q) step = norm((*ap - *bp) - (*aq - *bq));
  return dearness * (kSeamFloor + error / (lively + kContrast) + step);
}

struct Box {
  int x0, y0, x1, y1;  // half open
};

// A pixel of the box or beside it.
struct Place {
  int x = 0, y = 0;
  int node = kNone;            // of the graph, if it may change
  int label = kNone;           // present
  const Rgb* own = nullptr;    // what that shows here, if anything
  const Rgb* fresh = nullptr;  // what the patch shows here
};

// The pairwise terms of an expansion; source side = keep, sink side = take the patch (Kolmogorov and Zabih 2004).
class Terms {
 public:
  Terms(Graph& graph, const View& view, int index) : graph_(graph), view_(view), index_(index) {}

  void add_edge(const Place& p, const Place& q) {
    if (p.node == kNone && q.node == kNone) return;
    if (!p.own || !q.own) {
      // A pixel nobody covers yet will take the patch; its labelled neighbour pays for the seam if it stays as it is.
      const Place &other = p.own ? p : q, &taker = p.own ? q : p;
      if ((!p.own) != (!q.own) && other.node != kNone && taker.node != kNone) {
        graph_.add_tweights(other.node, 0.0f, to_fresh(other.label, p, q));
      }
      return;
    }
    if (p.node == kNone || q.node == kNone) {
      const float keep = between(p, q), take = to_fresh(p.node == kNone ? p.label : q.label, p, q);
      graph_.add_tweights(p.node == kNone ? q.node : p.node, take, keep);
      return;
    }
    const float e01 = to_fresh(p.label, p, q), e10 = p.label == q.label ? e01 : to_fresh(q.label, p, q);
    const float e00 = std::min(between(p, q), e01 + e10);  // truncated to stay submodular
    graph_.add_tweights(p.node, std::max(0.0f, e10 - e00), std::max(0.0f, e00 - e10));
    graph_.add_tweights(q.node, 0.0f, e10);
    graph_.add_edge(p.node, q.node, std::max(0.0f, e01 + e10 - e00), 0.0f);
  }

 private:
  // The seam between a present label and the patch.
  float to_fresh(int label, const Place& p, const Place& q) const {
    if (label == index_) return 0.0f;
    const Rgb* at_p = label == p.label ? p.own : view_.color(label, p.x, p.y);
    const Rgb* at_q = label == q.label ? q.own : view_.color(label, q.x, q.y);
    return seam(at_p, p.fresh, at_q, q.fresh, dearness(label, index_, p));
  }
  // The seam there is.
  float between(const Place& p, const Place& q) const {
    if (p.label == q.label) return 0.0f;
    return seam(p.own, view_.color(q.label, p.x, p.y), view_.color(p.label, q.x, q.y), q.own,
                dearness(p.label, q.label, p));
  }
  float dearness(int a, int b, const Place& p) const {
    return view_.precious(a, p.x, p.y) || view_.precious(b, p.x, p.y) ? 6.0f : 1.0f;
  }

  Graph& graph_;
  const View& view_;
  int index_;
};

}  // namespace

void expand_patch(const QuiltJob& job, Quilt& quilt, int index) {
  const QuiltPatch& patch = quilt.patches[index];
  const int width = quilt.label.width(), height = quilt.label.height();
  const Box box{std::max(0, patch.tx), std::max(0, patch.ty), std::min(width, patch.tx + patch.side),
                std::min(height, patch.ty + patch.side)};
  if (box.x0 >= box.x1 || box.y0 >= box.y1) return;
  const View view(job, quilt);
  // With the pixels to the left and above, and those to the right and below.
  const int left = std::max(0, box.x0 - 1), top = std::max(0, box.y0 - 1);
  Image<Place> places(std::min(width, box.x1 + 1) - left, std::min(height, box.y1 + 1) - top);
  int count = 0;
  for (int y = top; y < top + places.height(); ++y) {
    for (int x = left; x < left + places.width(); ++x) {
      Place& place = places(x - left, y - top);
      const bool inside = x >= box.x0 && y >= box.y0 && x < box.x1 && y < box.y1;
      place.x = x, place.y = y;
      if (inside && job.hole(x, y)) place.node = count++;
      place.label = quilt.label(x, y);
      place.own = view.color(place.label, x, y);
      place.fresh = view.color(index, x, y);
    }
  }
  if (count == 0) return;
  Graph graph(count, 2 * count + 8, no_memory);
  graph.add_node(count);
  for (const Place& place : places.pixels()) {
    if (place.node != kNone)
      graph.add_tweights(place.node, view.data(index, place.x, place.y), view.data(place.label, place.x, place.y));
  }
  Terms terms(graph, view, index);
  for (int y = top; y < box.y1; ++y) {
    for (int x = left; x < box.x1; ++x) {
      const Place& place = places(x - left, y - top);
      if (x + 1 < width && y >= box.y0) terms.add_edge(place, places(x + 1 - left, y - top));
      if (y + 1 < height && x >= box.x0) terms.add_edge(place, places(x - left, y + 1 - top));
    }
  }
  graph.maxflow();
  for (const Place& place : places.pixels()) {
    if (place.node == kNone || graph.what_segment(place.node) != Graph::SINK) continue;
    if (view.data(index, place.x, place.y) < kImpossible) quilt.label(place.x, place.y) = index;
  }
}

}  // namespace ramify
