// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/synthetic/synthetic.h"

#include <algorithm>

#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/skeleton/draw.h"
#include "ramify/synthetic/scene.h"

namespace ramify {
namespace {

Scene draw(SyntheticKind kind, Size size, const Rng& rng, const Monitor& monitor) {
  switch (kind) {
    case SyntheticKind::Lightning: return draw_lightning(size, rng, monitor);
    case SyntheticKind::River: return draw_river(size, rng, monitor);
    case SyntheticKind::Crack: return draw_crack(size, rng, monitor);
    case SyntheticKind::Vein: return draw_vein(size, rng, monitor);
    case SyntheticKind::Vessel: return draw_vessel(size, rng, monitor);
  }
  throw std::logic_error("draw: unknown kind");
}

}  // namespace

const std::vector<std::string>& synthetic_kind_names() {
  static const std::vector<std::string> names{"lightning", "river", "crack", "vein", "vessel"};
  return names;
}

SyntheticKind synthetic_kind(const std::string& name) {
  const auto& names = synthetic_kind_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError("builtin:" + printable(name),
                     "no such built-in exemplar; there are lightning, river, crack, vein and vessel");
  return static_cast<SyntheticKind>(found - names.begin());
}

Size natural_size(SyntheticKind kind) {
  switch (kind) {
    case SyntheticKind::Lightning: return {960, 640};
    case SyntheticKind::River: return {960, 640};
    case SyntheticKind::Crack: return {960, 640};
    case SyntheticKind::Vein: return {960, 640};
    case SyntheticKind::Vessel: return {880, 700};
  }
  throw std::logic_error("natural_size: unknown kind");
}

SyntheticExemplar make_synthetic(SyntheticKind kind, Size size, const Rng& rng, const Monitor& monitor) {
  const CancelScope scope(monitor);
  if (std::min(size.width, size.height) < 64 || std::max(size.width, size.height) > 16384)
    throw OptionError("size", std::to_string(size.width) + "x" + std::to_string(size.height),
                      "width and height of a synthetic photograph are 64 to 16384 px");
  const std::string& name = synthetic_kind_names()[static_cast<std::size_t>(kind)];
  Scene scene = draw(kind, size, rng.child(name), monitor);
  SyntheticExemplar out;
  out.photo.color = std::move(scene.color);
  out.photo.name = "builtin:" + name;
  out.skeleton = skeleton_of(size, scene.branches);
  out.branch_mask = draw_branch_mask(out.skeleton, size);
  out.light = scene.light.normalized();
  for (AnnotatedBranch& branch : scene.branches) branch.polarity = scene.polarity;
  out.annotation.photo_file = out.photo.name;
  out.annotation.photo_size = size;
  out.annotation.branches = std::move(scene.branches);
  out.annotation.regions = std::move(scene.regions);
  monitor.report(1.0);
  return out;
}

}  // namespace ramify
