// SPDX-License-Identifier: GPL-3.0-or-later
// How well a source disc would stand in for a target disc.
#pragma once

#include <array>
#include <vector>

#include "ramify/compose/placement.h"

namespace ramify {

struct SourceCandidate {
  int source = kNone;
  bool mirrored = false;
  bool backwards = false;           // the source's samples are taken in the other order
  double angle = 0.0;               // rad
  double cosine = 1.0, sine = 0.0;  // of the angle
  double scale = 1.0;
  double shape = 0.0;         // squared px per sample, relative to the disc radius (paper 002, equation 1)
  double disagreement = 0.0;  // 0..1
  double cost = 0.0;          // all terms that do not depend on other choices
};

// A shape vector as plain numbers.
struct BranchShape {
  std::array<Vec2, 17> points;   // px from the centre
  std::array<double, 17> radii;  // px
  std::size_t count = 0;
};

// A source, ready to be compared.
struct SourceShape {
  BranchShape straight, mirrored, backwards;  // backwards: straight, entered from its end
  double log_radius = 0.0;                    // log(branch radius + 1)
  double faintness = 0.0;                     // 0.9 minus the share of the usual contrast, at least 0
};

// What all targets are compared with.
struct CandidateContext {
  CandidateContext(const FragmentLibrary& photo_library, const BranchField& canvas_field, const PlacementOptions& choices);

  const FragmentLibrary& library;
  const BranchField& field;          // of the canvas
  const PlacementOptions& options;
  std::vector<SourceShape> shapes;   // beside library.fragments
  ColorImage photo_low, canvas_low;  // low-pass Lab; canvas_low may be empty
  std::uint64_t seed = 0;
};

// The offset from the source's centre on the photo that an offset from the target's centre is taken from, unbent.
Vec2 photo_offset(const SourceCandidate& candidate, const Vec2& canvas_offset);

// Which sample of the source lies on the target's.
inline std::size_t paired_sample(const Fragment& source, bool backwards, std::size_t sample) {
  return backwards ? source.shape.size() - 1 - sample : sample;
}

// The best candidates of a target, best first; empty when the photo has nothing of its kind.
std::vector<SourceCandidate> rank_candidates(const CandidateContext& context, const Fragment& target, int target_index);

// Mean squared Lab difference of two overlapping discs within their overlap, most of the mean offset taken out (blending
// removes offsets); 0 when they do not overlap. `photo` is the slightly blurred Lab photo.
double overlap_difference(const FragmentLibrary& library, const ColorImage& photo, const Fragment& target_a,
                          const SourceCandidate& a, const Fragment& target_b, const SourceCandidate& b);

}  // namespace ramify
