// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/color_profile.h"

#include <lcms2.h>

#include <cmath>
#include <vector>

#include "ramify/image/color.h"

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

// sRGB's primaries with linear light. Little CMS extends the sRGB curve below zero along a straight line; we encode
// with our own curve, which mirrors it.
cmsHPROFILE linear_srgb_profile() {
  const cmsCIExyY white{0.3127, 0.3290, 1.0};
  const cmsCIExyYTRIPLE primaries{{0.64, 0.33, 1.0}, {0.30, 0.60, 1.0}, {0.15, 0.06, 1.0}};
  cmsToneCurve* line = cmsBuildGamma(nullptr, 1.0);
  cmsToneCurve* lines[3] = {line, line, line};
  cmsHPROFILE profile = cmsCreateRGBProfile(&white, &primaries, lines);
  cmsFreeToneCurve(line);
  return profile;
}

}  // namespace

ColorProfile::ColorProfile(const std::string& icc, ColorModel model) : model_(model) {
  cmsSetLogErrorHandler(keep_silent);
  const ModelTraits traits = traits_of(model);
  cmsHPROFILE from = cmsOpenProfileFromMem(icc.data(), static_cast<cmsUInt32Number>(icc.size()));
  if (!from) return;
  if (cmsGetColorSpace(from) == traits.space) {
    cmsHPROFILE to = linear_srgb_profile();
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
        const float in[4] = {r / float{kSteps}, g / float{kSteps}, b / float{kSteps}, 0.0f};  // as wide as any model
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
  std::vector<float> percent;
  if (model_ == ColorModel::Cmyk) {  // Little CMS counts ink in percent
    percent.assign(from, from + 4 * static_cast<std::size_t>(count));
    for (float& ink : percent) ink *= 100.0f;
    from = percent.data();
  }
  cmsDoTransform(transform_, from, to, static_cast<cmsUInt32Number>(count));
  for (int i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) to[i][c] = srgb_from_linear(to[i][c]);
  }
}

}  // namespace ramify
