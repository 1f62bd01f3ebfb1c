// SPDX-License-Identifier: GPL-3.0-or-later
// The quality report: what `compare A B` and `synth --report` write. Every figure of a result stands beside the same figure
// of its exemplar and beside what parts of the exemplar differ by.
#pragma once

#include <string>
#include <vector>

#include "ramify/compose/compose.h"
#include "ramify/core/monitor.h"
#include "ramify/core/random.h"
#include "ramify/image/image.h"
#include "ramify/report/figure.h"
#include "ramify/report/structure_figures.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct ReportSubject {
  std::string name;
  Skeleton skeleton;                      // empty when there is none
  ColorImage color;                       // sRGB; empty when there is none
  const Composite* provenance = nullptr;  // where the picture's pixels come from, for results just made
};

struct ReportPicture {
  std::string caption;
  ColorImage image;
};

struct Report {
  std::string exemplar_name, result_name;
  std::vector<Figure> structure, picture;
  std::vector<HistogramFigure> histograms;
  std::vector<ReportPicture> pictures;  // both sides, reduced to at most 1000 px
  std::vector<ReportPicture> crops;     // the worst seams, enlarged
};

// Figures of structure, and of pictures when both have one. Throws InputError when either has no skeleton.
Report make_report(const ReportSubject& exemplar, const ReportSubject& result, Rng rng, const Monitor& monitor);

// The number of figures that failed.
int failures(const Report& report);

// .html: one file with everything in it; .svg: the histograms; .json: the figures. check_report_name throws OptionError
// for other extensions.
void check_report_name(const std::string& path);
std::string report_text(const Report& report, const std::string& path);
std::string report_html(const Report& report);
std::string report_svg(const Report& report);
std::string report_json(const Report& report);

}  // namespace ramify
