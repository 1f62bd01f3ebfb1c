// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/color_profile.h"

#include <lcms2.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ramify {
namespace {

void keep_silent(cmsContext, cmsUInt32Number, const char*) {}

struct ModelTraits {
  cmsColorSpaceSignature space;
  cmsUInt32Number type;
};

ModelTraits traits_of(ColorModel model) {
  if (model == ColorModel::Grey) return {cmsSigGrayData, TYPE_GRAY_FLT};
  if (model == ColorModel::Rgb) return {cmsSigRgbData, TYPE_RGB_FLT};
  return {cmsSigCmykData, TYPE_CMYK_FLT};
}

}  // namespace

ColorProfile::ColorProfile(const std::string& icc, ColorModel model) : model_(model) {
  cmsSetLogErrorHandler(keep_silent);
  const ModelTraits traits = traits_of(model);
  cmsHPROFILE from = cmsOpenProfileFromMem(icc.data(), static_cast<cmsUInt32Number>(icc.size()));
  if (!from) return;
  if (cmsGetColorSpace(from) == traits.space) {
    cmsHPROFILE to = cmsCreate_sRGBProfile();
    transform_ = cmsCreateTransform(from, traits.type, to, TYPE_RGB_FLT, INTENT_RELATIVE_COLORIMETRIC,
                                    cmsFLAGS_NOCACHE | cmsFLAGS_NOOPTIMIZE);
    cmsCloseProfile(to);
  }
  cmsCloseProfile(from);
  is_srgb_ = usable() && changes_nothing();
}

ColorProfile::~ColorProfile() {
  if (transform_) cmsDeleteTransform(transform_);
}

bool ColorProfile::changes_nothing() const {
  if (model_ == ColorModel::Cmyk) return false;
  const bool grey = model_ == ColorModel::Grey;
  constexpr int kSteps = 8;
  for (int r = 0; r <= kSteps; ++r) {
    for (int g = 0; g <= (grey ? 0 : kSteps); ++g) {
      for (int b = 0; b <= (grey ? 0 : kSteps); ++b) {
        const float in[3] = {r / float{kSteps}, g / float{kSteps}, b / float{kSteps}};
        Rgb out;
        convert(in, &out, 1);
        for (int c = 0; c < 3; ++c) {
          if (!(std::abs(out[c] - in[grey ? 0 : c]) <= 0.25f / 255.0f)) return false;
        }
      }
    }
  }
  return true;
}

void ColorProfile::convert(const float* from, Rgb* to, int count) const {
  if (model_ != ColorModel::Cmyk) {
    cmsDoTransform(transform_, from, to, static_cast<cmsUInt32Number>(count));
    return;
  }
  std::vector<float> percent(from, from + 4 * static_cast<std::size_t>(count));  // Little CMS counts ink in percent
  for (float& ink : percent) ink *= 100.0f;
  cmsDoTransform(transform_, percent.data(), to, static_cast<cmsUInt32Number>(count));
}

}  // namespace ramify
