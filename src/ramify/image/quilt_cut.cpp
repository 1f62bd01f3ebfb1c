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

  // Kwatra's seam cost between labels a and b on the edge p-q, weighed by the liveliness of both pictures.
  float seam(int a, int b, int px, int py, int qx, int qy) const {
    if (a == b) return 0.0f;
    const Rgb *ap = color(a, px, py), *bp = color(b, px, py), *aq = color(a, qx, qy), *bq = color(b, qx, qy);
    float error = 0.0f, lively = 0.0f, step = 0.0f;
    const bool at_p = ap && bp, at_q = aq && bq;
    if (!at_p && !at_q) return 1.0f;
    if (at_p) error += norm(*ap - *bp);
    if (at_q) error += norm(*aq - *bq);
    if (at_p != at_q) error *= 2.0f;
    if (ap && aq) lively += norm(*ap - *aq);
    if (bp && bq) lively += norm(*bp - *bq);
    if (at_p && at_q) step = norm((*ap - *bp) - (*aq - *bq));
    const float cost = kSeamFloor + error / (lively + kContrast) + step;
    return precious(a, px, py) || precious(b, px, py) ? 6.0f * cost : cost;
  }

 private:
  bool precious(int label, int x, int y) const {
    if (label == kNone || job_.precious.empty()) return false;
    const QuiltPatch& p = quilt_.patches[label];
    const int u = p.source_x(x), v = p.source_y(y);
    return job_.precious.contains(u, v) && job_.precious(u, v);
  }

  const QuiltJob& job_;
  const Quilt& quilt_;
};

struct Box {
  int x0, y0, x1, y1;  // half open
  bool contains(int x, int y) const { return x >= x0 && y >= y0 && x < x1 && y < y1; }
};

// Adds the pairwise terms of the edge p-q; source side = keep, sink side = take the patch (Kolmogorov and Zabih 2004).
void add_edge(Graph& graph, const View& view, const Quilt& quilt, int index, const Image<int>& node, const Box& box,
              int px, int py, int qx, int qy) {
  const auto id = [&](int x, int y) { return box.contains(x, y) ? node(x - box.x0, y - box.y0) : kNone; };
  const int a = id(px, py), b = id(qx, qy);
  if (a == kNone && b == kNone) return;
  const int lp = quilt.label(px, py), lq = quilt.label(qx, qy);
  const bool empty_p = view.color(lp, px, py) == nullptr, empty_q = view.color(lq, qx, qy) == nullptr;
  if (empty_p || empty_q) {
    // A pixel nobody covers yet will take the patch; its labelled neighbour pays for the seam if it stays as it is.
    const int other = empty_p ? b : a, taker = empty_p ? a : b;
    if (empty_p != empty_q && other != kNone && taker != kNone)
      graph.add_tweights(other, 0.0f, view.seam(empty_p ? lq : lp, index, px, py, qx, qy));
    return;
  }
  if (a == kNone || b == kNone) {
    const float keep = view.seam(lp, lq, px, py, qx, qy);
    const float take = a == kNone ? view.seam(lp, index, px, py, qx, qy) : view.seam(index, lq, px, py, qx, qy);
    graph.add_tweights(a == kNone ? b : a, take, keep);
    return;
  }
  const float e01 = view.seam(lp, index, px, py, qx, qy), e10 = view.seam(index, lq, px, py, qx, qy);
  const float e00 = std::min(view.seam(lp, lq, px, py, qx, qy), e01 + e10);  // truncated to stay submodular
  graph.add_tweights(a, std::max(0.0f, e10 - e00), std::max(0.0f, e00 - e10));
  graph.add_tweights(b, 0.0f, e10);
  graph.add_edge(a, b, std::max(0.0f, e01 + e10 - e00), 0.0f);
}

}  // namespace

void expand_patch(const QuiltJob& job, Quilt& quilt, int index) {
  const QuiltPatch& patch = quilt.patches[index];
  const int width = quilt.label.width(), height = quilt.label.height();
  const Box box{std::max(0, patch.tx), std::max(0, patch.ty), std::min(width, patch.tx + patch.side),
                std::min(height, patch.ty + patch.side)};
  if (box.x0 >= box.x1 || box.y0 >= box.y1) return;
  const View view(job, quilt);
  Image<int> node(box.x1 - box.x0, box.y1 - box.y0, kNone);
  int count = 0;
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      if (job.hole(x, y)) node(x - box.x0, y - box.y0) = count++;
    }
  }
  if (count == 0) return;
  Graph graph(count, 2 * count + 8, no_memory);
  graph.add_node(count);
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      const int id = node(x - box.x0, y - box.y0);
      if (id != kNone) graph.add_tweights(id, view.data(index, x, y), view.data(quilt.label(x, y), x, y));
    }
  }
  for (int y = std::max(0, box.y0 - 1); y < box.y1; ++y) {
    for (int x = std::max(0, box.x0 - 1); x < box.x1; ++x) {
      if (x + 1 < width && y >= box.y0) add_edge(graph, view, quilt, index, node, box, x, y, x + 1, y);
      if (y + 1 < height && x >= box.x0) add_edge(graph, view, quilt, index, node, box, x, y, x, y + 1);
    }
  }
  graph.maxflow();
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      const int id = node(x - box.x0, y - box.y0);
      if (id == kNone || graph.what_segment(id) != Graph::SINK) continue;
      if (view.data(index, x, y) < kImpossible) quilt.label(x, y) = index;
    }
  }
}

}  // namespace ramify
