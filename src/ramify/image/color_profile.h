// SPDX-License-Identifier: GPL-3.0-or-later
// ICC profiles to sRGB with Little CMS: relative colorimetric, in floating point, not clamped. Private to this layer.
#pragma once

#include <memory>
#include <string>

#include "ramify/image/vips_codec.h"

namespace ramify {

class ColorProfile {
 public:
  // Not usable when the profile is broken or made for another colour model.
  ColorProfile(const std::string& icc, ColorModel model);
  ~ColorProfile();

  bool usable() const { return transform_ != nullptr; }
  // True when it changes no colour by more than a quarter of an 8-bit step, as the sRGB profiles in most photos do;
  // such pictures keep their exact values.
  bool is_srgb() const { return is_srgb_; }

  // `from`: 1, 3 or 4 values 0..1 per pixel (CMYK: 1 = full ink). May be called from several threads.
  void convert(const float* from, Rgb* to, int count) const;

 private:
  bool changes_nothing() const;

  void* transform_ = nullptr;  // cmsHTRANSFORM
  ColorModel model_;
  bool is_srgb_ = false;
};

}  // namespace ramify
