// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_patch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "ramify/compose/light_tone.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

constexpr double kThin = 3.2;                        // px; thin branches have their rim nearer
constexpr double kRimThin = 0.55, kRimThick = 0.74;  // share of s where the surround begins
constexpr double kForeignCost = 1.5;
constexpr double kUnevenCost = 3.0;
constexpr double kRimFrom = 0.8;    // share of s from where the disc itself fades, for ends and hairpins
constexpr double kEvenFrom = 4.0;   // px, radius from which strokes have even edges; wholly from twice that
constexpr float kSpike = 1.5f;      // of the median light as far from the line
constexpr float kSpikeFoot = 0.02f; // linear light, over the channels
constexpr double kSharpTurn = 1.0;  // rad within one radius s

double ramp(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

// What is left at p, nearest to sample t: free ends fade, and nothing sticks out behind a parent.
double fade_at(const Strand& target, const Vec2& p, int t, const LightRules& rules) {
  double fade = end_fade(target, t, rules.tip_fade);
  if (target.parent != kNone && t == target.first) {
    const Vec2 n = target.normals[t], tangent(n.y(), -n.x());
    const double beyond = -(p - target.points[t]).dot(tangent) - target.behind;
    fade *= 1.0 - ramp(beyond / (0.5 * target.radii[t] + 2.0));
  }
  return fade;
}

// Foreign branches as 0..1 over the box: labels other than the own, one pixel wider, softened.
std::vector<float> foreign_share(const LightSource& source, const PatchFrame& frame, const LightPatch& patch, int own) {
  const int n = frame.box.size;
  std::vector<float> hit(patch.source.size()), wide(hit.size()), soft(hit.size());
  bool any = false;
  for (std::size_t i = 0; i < hit.size(); ++i) {
    const Eigen::Vector2f& p = patch.source[i];
    const int label = source.labels.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
    hit[i] = label != 0 && label != own ? 1.0f : 0.0f;
    any |= hit[i] > 0.0f;
  }
  if (!any) return hit;
  const auto around = [&](const std::vector<float>& in, std::vector<float>& out, const auto& combine) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        float v = 0.0f;
        for (int j = -1; j <= 1; ++j)
          for (int i = -1; i <= 1; ++i)
            v = combine(v, in[std::clamp(y + j, 0, n - 1) * n + std::clamp(x + i, 0, n - 1)], i, j);
        out[y * n + x] = v;
      }
    }
  };
  around(hit, wide, [](float v, float u, int, int) { return std::max(v, u); });
  around(wide, soft,
         [](float v, float u, int i, int j) { return v + u * (i ? 1.0f : 2.0f) * (j ? 1.0f : 2.0f) / 16.0f; });
  for (std::size_t i = 0; i < soft.size(); ++i)
    if (frame.distance[i] < 0.85 * frame.radius) soft[i] = 0.0f;
  return soft;
}

// Takes off the plane the layer makes in the disc's rim: what is left of the surround's light or shade.
void remove_plane(const PatchFrame& frame, const std::vector<float>& foreign, LightPatch& patch) {
  const int n = frame.box.size;
  const double s = frame.box.s, core = 1.3 * frame.radius + 2.0;
  const double from = std::max(core, (frame.radius < kThin ? kRimThin : kRimThick) * s);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), right = Eigen::Matrix3d::Zero();
  int count = 0;
  const auto row = [&](int x, int y) {
    const Vec2 p = (Vec2(frame.box.x0 + x, frame.box.y0 + y) - frame.box.centre) / s;
    return Eigen::Vector3d(1.0, p.x(), p.y());
  };
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * n + x;
      const Eigen::Vector3d a = row(x, y);
      if (frame.distance[i] <= from || foreign[i] >= 0.25f || a.tail<2>().squaredNorm() >= 1.0) continue;
      normal += a * a.transpose();
      for (int c = 0; c < 3; ++c) right.col(c) += a * patch.value[i][c];
      ++count;
    }
  }
  if (count <= 12) return;
  normal += 1e-6 * count * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d plane = normal.fullPivLu().solve(right);
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const Eigen::RowVector3d v = row(x, y).transpose() * plane;
      Rgb& p = patch.value[static_cast<std::size_t>(y) * n + x];
      for (int c = 0; c < 3; ++c) p[c] -= static_cast<float>(v[c]);
    }
  }
}

Rgb blend_at(const std::vector<Rgb>& values, int n, const Eigen::Vector2f& p) {
  const float x = std::clamp(p.x(), 0.0f, n - 1.001f), y = std::clamp(p.y(), 0.0f, n - 1.001f);
  const int i = static_cast<int>(x), j = static_cast<int>(y), k = j * n + i;
  const float u = x - i, v = y - j;
  return (1 - v) * ((1 - u) * values[k] + u * values[k + 1]) + v * ((1 - u) * values[k + n] + u * values[k + n + 1]);
}

// Foreign branches give way to the same distance across the axis; where that is foreign as well, to nothing.
void mirror_out(const PatchFrame& frame, const std::vector<float>& foreign, LightPatch& patch) {
  const int n = frame.box.size;
  const std::vector<Rgb> before = patch.value;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (foreign[i] <= 0.0f) continue;
    Rgb v = (1.0f - foreign[i]) * before[i];
    const double near = std::clamp((2.2 * frame.radius + 4.0 - frame.distance[i]) / 3.0, 0.0, 1.0);
    if (frame.mirrorable && near > 0.0) {
      const Eigen::Vector2f& m = frame.mirror[i];
      const int k = std::clamp(static_cast<int>(std::lround(m.y())), 0, n - 1) * n +
                    std::clamp(static_cast<int>(std::lround(m.x())), 0, n - 1);
      v = v + static_cast<float>(foreign[i] * (1.0f - foreign[k]) * near) * blend_at(before, n, m);
    }
    patch.value[i] = v;
  }
}

// Thick strokes have even edges; what stands out of them, brighter than the median as far from the line on the darker
// side, is the start of a branch or a tick of a fold. Thin ones are all zigzag and stay as they are.
void cut_spikes(const PatchFrame& frame, LightPatch& patch) {
  const double thick = std::clamp((frame.radius - kEvenFrom) / kEvenFrom, 0.0, 1.0);
  if (thick <= 0.0) return;
  const int rings = static_cast<int>(frame.box.s) + 1;
  std::vector<std::vector<float>> light(static_cast<std::size_t>(2 * rings));
  const auto ring_of = [&](std::size_t i) {
    const int ring = std::min(rings - 1, static_cast<int>(frame.distance[i]));
    return static_cast<std::size_t>(frame.points[i].across < 0.0f ? ring : rings + ring);
  };
  const auto strength = [](const Rgb& v) { return v.r + v.g + v.b; };
  for (std::size_t i = 0; i < patch.value.size(); ++i) {
    if (frame.window[i] > 0.0f) light[ring_of(i)].push_back(strength(patch.value[i]));
  }
  for (std::vector<float>& ring : light) {
    if (ring.empty()) continue;
    const auto middle = ring.begin() + static_cast<std::ptrdiff_t>(ring.size() / 2);
    std::nth_element(ring.begin(), middle, ring.end());
    ring = {*middle};
  }
  for (std::size_t i = 0; i < patch.value.size(); ++i) {
    if (frame.window[i] <= 0.0f || frame.distance[i] < 0.5 * frame.radius) continue;
    const std::size_t ring = ring_of(i), across = ring < light.size() / 2 ? ring + light.size() / 2 : ring - light.size() / 2;
    const float other = light[across].empty() ? light[ring].front() : light[across].front();
    const float most = kSpike * std::min(light[ring].front(), other) + kSpikeFoot, own = strength(patch.value[i]);
    if (own > most) patch.value[i] = static_cast<float>(1.0 - thick * (1.0 - most / own)) * patch.value[i];
  }
}

double flaw_cost(const PatchFrame& frame, const std::vector<float>& foreign, const LightPatch& patch) {
  double alien = 0.0;
  int core = 0;
  std::vector<float> inner;
  for (std::size_t i = 0; i < patch.value.size(); ++i) {
    if (!frame.core[i]) continue;
    alien += foreign[i], ++core;
    if (frame.distance[i] < 0.7 * frame.radius)
      inner.push_back((patch.value[i].r + patch.value[i].g + patch.value[i].b) / 3.0f);
  }
  double uneven = 0.0;
  if (inner.size() > 4) {
    std::vector<float> sorted = inner;
    std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
    const double median = sorted[sorted.size() / 2];
    for (const float v : inner) uneven += std::max(0.0, 0.6 * median - v);
    uneven /= static_cast<double>(inner.size()) * (std::abs(median) + 1e-3);
  }
  return kForeignCost * alien / std::max(1, core) + kUnevenCost * uneven;
}

}  // namespace

PatchFrame patch_frame(const Strand& target, int sample, const LightRules& rules) {
  PatchFrame frame;
  frame.box = patch_box(target, sample, rules);
  frame.sample = sample;
  frame.radius = target.radii[sample];
  const double s = frame.box.s, core = 1.3 * frame.radius + 2.0, band = 0.8 * s, flat = std::max(core, 0.45 * band);
  const int reach = static_cast<int>(2.0 * s) + 4;
  const int from = std::max(target.first, sample - reach), to = std::min(target.count(), sample + reach + 1);
  const int ahead = std::min(target.count() - 1, sample + static_cast<int>(s));
  const int back = std::max(target.first, sample - static_cast<int>(s));
  frame.mirrorable = target.normals[back].dot(target.normals[ahead]) > std::cos(kSharpTurn) &&
                     target.normals[back].dot(target.normals[sample]) > std::cos(0.7 * kSharpTurn);
  for (int y = 0; y < frame.box.size; ++y) {
    for (int x = 0; x < frame.box.size; ++x) {
      const Vec2 p(frame.box.x0 + x, frame.box.y0 + y);
      const bool inside = (p - frame.box.centre).squaredNorm() < s * s;
      const StrandPoint at = locate(target, p, from, to);
      const int t = std::clamp(static_cast<int>(std::lround(at.along)), from, to - 1);
      const double d = (p - target.points[t]).norm();
      const Vec2 across = p - 2.0 * (p - target.points[t]).dot(target.normals[t]) * target.normals[t];
      frame.points.push_back(at);
      frame.distance.push_back(static_cast<float>(d));
      const double rim = ((p - frame.box.centre).norm() / s - kRimFrom) / (1.0 - kRimFrom);
      frame.window.push_back(static_cast<float>((1.0 - ramp((d - flat) / (band - flat + 1e-6))) * (1.0 - ramp(rim))));
      frame.fade.push_back(static_cast<float>(fade_at(target, p, t, rules)));
      frame.mirror.push_back((across - Vec2(frame.box.x0, frame.box.y0)).cast<float>());
      frame.core.push_back(inside && d < core);
    }
  }
  return frame;
}

LightPatch cut_patch(const LightSource& source, const LightLayer& layer, const PatchFrame& frame, const Strand& target,
                     const LightMatch& match, const LightRules& rules, bool fine) {
  LightPatch patch;
  patch.place = match.place;
  patch.source = photo_from_strand(source, match.place, target, frame.sample, frame.points);
  patch.value.resize(patch.source.size());
  for (std::size_t i = 0; i < patch.value.size(); ++i) {
    if (fine && frame.window[i] <= 0.0f && frame.distance[i] > frame.box.s) continue;
    const Vec2 p = patch.source[i].cast<double>();
    patch.value[i] = fine ? sample_lanczos3(layer.value, p) : sample_bilinear(layer.value, p);
  }
  const std::vector<float> foreign = foreign_share(source, frame, patch, match.place.strand + 1);
  remove_plane(frame, foreign, patch);
  const auto floor = static_cast<float>(rules.floor);
  for (Rgb& v : patch.value) v = {std::max(v.r, floor), std::max(v.g, floor), std::max(v.b, floor)};
  patch.cost = match.cost + flaw_cost(frame, foreign, patch);
  mirror_out(frame, foreign, patch);
  if (layer.mode == CompositeMode::Emit) cut_spikes(frame, patch);
  const ToneGain gains = tone_gain(source.strands[match.place.strand], match.place.sample, target, frame.sample,
                                   static_cast<int>(2.0 * frame.box.s));
  for (std::size_t i = 0; i < patch.value.size(); ++i) {
    const Vec3& gain = gains.at(frame.points[i].along);
    const float fade = frame.fade[i];
    for (int c = 0; c < 3; ++c) {
      float& v = patch.value[i][c];
      if (gain[c] < 1.0 || fade < 1.0f) v = std::min(v, 1.0f);  // dim what is seen, not what burnt out
      v *= static_cast<float>(gain[c]) * fade;
    }
  }
  return patch;
}

}  // namespace ramify
