// SPDX-License-Identifier: GPL-3.0-or-later
// One number of a report, beside the same number of the exemplar and what the exemplar's own parts differ by.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace ramify {

enum class Verdict { None, Pass, Fail };

struct Figure {
  std::string key;                 // for machines: "angle_tv"
  std::string label;               // for people
  std::string unit;                // "px", "deg", "" for a pure number
  std::optional<double> exemplar;  // of the exemplar, where the figure has a value of its own there
  std::optional<double> result;    // of the result, or the distance of both
  std::optional<double> spread;    // between parts of the exemplar
  std::string limit;               // what passes, in words; empty without verdict
  Verdict verdict = Verdict::None;
};

// `result` within [low, high] passes.
Figure judged(Figure figure, double low, double high, std::string limit);

}  // namespace ramify
