// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/report/report.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/core/json.h"
#include "ramify/core/parallel.h"
#include "ramify/image/sample.h"
#include "ramify/report/histogram_plot.h"
#include "ramify/report/picture_figures.h"

namespace ramify {
namespace {

constexpr int kShownSide = 1000;   // px, of pictures in the report
constexpr int kWorstSeams = 5;
constexpr int kCropScale = 3;

ColorImage reduced(const ColorImage& image) {
  const int longer = std::max(image.width(), image.height());
  if (longer <= kShownSide) return image;
  const auto side = [&](int s) { return std::max(1, static_cast<int>(std::lround(static_cast<double>(s) * kShownSide / longer))); };
  return resize(image, {side(image.width()), side(image.height())});
}

ColorImage enlarged(const ColorImage& image, int times) {
  ColorImage out(image.width() * times, image.height() * times);
  for (int y = 0; y < out.height(); ++y) {
    for (int x = 0; x < out.width(); ++x) out(x, y) = image(x / times, y / times);
  }
  return out;
}

void add_crops(const ReportSubject& result, Report& report) {
  for (const WorstSeam& seam : find_worst_seams(result.color, result.provenance->owner, kWorstSeams)) {
    const std::string caption = "seams at " + std::to_string(seam.x) + "," + std::to_string(seam.y) + ": " + figure_text(seam.ratio);
    report.crops.push_back({caption, enlarged(crop(result.color, seam.x, seam.y, kSeamTile, kSeamTile), kCropScale)});
  }
}

std::string extension_of(const std::string& path) {
  std::string extension = path.substr(std::min(path.rfind('.'), path.size()));
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

Json number_or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json();
}

Json figure_list(const std::vector<Figure>& figures) {
  Json::Object list;
  for (const Figure& f : figures) {
    Json::Object fields{{"label", f.label}, {"unit", f.unit}, {"exemplar", number_or_null(f.exemplar)},
                        {"result", number_or_null(f.result)}, {"spread", number_or_null(f.spread)}};
    if (f.verdict != Verdict::None) {
      fields.push_back({"limit", f.limit});
      fields.push_back({"pass", f.verdict == Verdict::Pass});
    }
    list.push_back({f.key, std::move(fields)});
  }
  return list;
}

}  // namespace

Report make_report(const ReportSubject& exemplar, const ReportSubject& result, Rng rng, const Monitor& monitor) {
  const CancelScope scope(monitor);
  const bool structure = !exemplar.skeleton.empty() && !result.skeleton.empty();
  if (!structure) {
    throw InputError((exemplar.skeleton.empty() ? exemplar : result).name, "there is no skeleton to compare; give an exemplar, a skeleton or a picture made by ramify");
  }
  Report report;
  report.exemplar_name = exemplar.name;
  report.result_name = result.name;
  StructureComparison comparison = compare_structure(exemplar.skeleton, result.skeleton, rng.child("structure"));
  report.structure = std::move(comparison.figures);
  report.histograms = std::move(comparison.histograms);
  monitor.report(0.3);
  if (!exemplar.color.empty()) report.pictures.push_back({exemplar.name, reduced(exemplar.color)});
  if (!result.color.empty()) report.pictures.push_back({result.name, reduced(result.color)});
  if (!exemplar.color.empty() && !result.color.empty()) {
    Provenance provenance;
    if (result.provenance) provenance = {&result.provenance->owner, &result.provenance->source, result.provenance->composite == CompositeMode::Emit};
    report.picture = compare_pictures({exemplar.color, exemplar.skeleton}, {result.color, result.skeleton}, provenance,
                                      rng.child("picture"), monitor.stage("picture", 0.3, 0.95));
    if (result.provenance) add_crops(result, report);
  }
  monitor.report(1.0);
  return report;
}

int failures(const Report& report) {
  const auto failed = [](const Figure& f) { return f.verdict == Verdict::Fail; };
  return static_cast<int>(std::count_if(report.structure.begin(), report.structure.end(), failed) +
                          std::count_if(report.picture.begin(), report.picture.end(), failed));
}

void check_report_name(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension != ".html" && extension != ".svg" && extension != ".json") {
    throw OptionError("output", "'" + printable(path) + "'", "reports are written as .html, .svg or .json");
  }
}

std::string report_text(const Report& report, const std::string& path) {
  check_report_name(path);
  const std::string extension = extension_of(path);
  return extension == ".html" ? report_html(report) : extension == ".svg" ? report_svg(report) : report_json(report);
}

std::string report_svg(const Report& report) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + histogram_plots(report.histograms, report.exemplar_name, report.result_name);
}

std::string report_json(const Report& report) {
  Json::Array histograms;
  for (const HistogramFigure& h : report.histograms) {
    const auto shares = [](const ShareHistogram& histogram) {
      Json::Array list;
      for (const double s : histogram.shares) list.push_back(s);
      return Json(list);
    };
    histograms.push_back(Json::Object{{"label", h.label}, {"unit", h.unit}, {"low", h.exemplar.low}, {"high", h.exemplar.high},
                                      {"exemplar", shares(h.exemplar)}, {"result", shares(h.result)}});
  }
  return json_text(Json::Object{{"format", "ramify-report"}, {"version", 1}, {"exemplar", report.exemplar_name},
                                {"result", report.result_name}, {"failed", failures(report)},
                                {"structure", figure_list(report.structure)}, {"picture", figure_list(report.picture)},
                                {"histograms", std::move(histograms)}});
}

}  // namespace ramify
