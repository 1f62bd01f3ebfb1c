// SPDX-License-Identifier: GPL-3.0-or-later
// A style as JSON. Numbers are written with the shortest text that reads back as the same double, so a round trip is
// exact.
#include <algorithm>
#include <array>

#include "ramify/core/json.h"
#include "ramify/core/options.h"
#include "ramify/style/style.h"

namespace ramify {
namespace {

constexpr char kFormat[] = "ramify-style";
constexpr int kVersion = 1;

const std::array<const char*, 3> kEndNames{"tip", "frame", "join"};

Json list_json(const auto& values) {
  Json::Array out;
  for (const auto value : values) out.push_back(value);
  return out;
}

Json histogram_json(const Histogram& h) {
  return Json::Object{{"low", h.low}, {"high", h.high}, {"counts", list_json(h.counts)}, {"total", h.total}};
}

Json headings_json(const std::array<Headings, kHeadingOrders>& all) {
  Json::Array out;
  for (const Headings& h : all) out.push_back(Json::Object{{"share", list_json(h.share)}, {"strength", h.strength}});
  return out;
}

Json bending_json(const BendingModel& m) {
  Json::Array vertices;
  for (int i = 0; i < m.vertex_count(); ++i) {
    vertices.push_back(Json::Array{m.point[i].x(), m.point[i].y(), m.alpha[i], m.radius[i], m.smooth_radius[i]});
  }
  return Json::Object{{"step", m.step},
          {"extension", m.extension},
          {"history", m.history},
          {"first", list_json(m.first)},
          {"vertices", vertices},
          {"angle_gain", m.angle_gain},
          {"radius_gain", m.radius_gain},
          {"angles", histogram_json(m.angles)},
          {"radii", histogram_json(m.radii)}};
}

Json furcation_json(const FurcationModel& m) {
  return Json::Object{{"half_window", m.half_window},
          {"absolute_angles", m.absolute_angles},
          {"trained", m.trained},
          {"mean", list_json(m.mean)},
          {"deviation", list_json(m.deviation)},
          {"weight", list_json(m.weight)},
          {"bias", m.bias},
          {"slope", m.slope},
          {"offset", m.offset},
          {"positives", m.positives},
          {"auc", m.auc},
          {"auc_shape", m.auc_shape},
          {"gap_log_mean", m.gap_log_mean},
          {"gap_log_deviation", m.gap_log_deviation},
          {"rate", list_json(m.rate)}};
}

Json hierarchy_json(const Hierarchy& h) {
  Json::Array branches;
  for (const SourceBranch& b : h.branches) {
    branches.push_back(Json::Object{{"parent", b.parent},
                        {"parent_vertex", b.parent_vertex},
                        {"order", b.order},
                        {"tree", b.tree},
                        {"rim_angle", b.rim_angle},
                        {"start_angle", b.start_angle},
                        {"ratio", b.ratio},
                        {"starts_on_frame", b.starts_on_frame},
                        {"starts_on_landmark", b.starts_on_landmark},
                        {"end", kEndNames[static_cast<std::size_t>(b.end)]}});
  }
  return Json::Object{{"branches", branches},
                      {"headings", headings_json(h.headings)},
                      {"ray_headings", headings_json(h.ray_headings)},
                      {"lags", list_json(h.lags)},
                      {"lag_turn", list_json(h.lag_turn)},
                      {"lag_chord", list_json(h.lag_chord)},
                      {"lag_winding", list_json(h.lag_winding)},
                      {"tip_profile", list_json(h.tip_profile)},
                      {"most_ratio", h.most_ratio},
                      {"least_radius", h.least_radius},
                      {"side_gap", h.side_gap},
                      {"highest_order", h.highest_order},
                      {"spacing", h.spacing},
                      {"clearance", h.clearance},
                      {"opening", h.opening},
                      {"chord_spread", list_json(h.chord_spread)},
                      {"total_length", h.total_length},
                      {"furcation_gap", h.furcation_gap},
                      {"habitat", list_json(h.habitat)}};
}

// A value of the document: every complaint names the file and the path.
class Reader {
 public:
  Reader(const JsonDocument& document, const Json& value) : document_(document), value_(value) {}

  Reader operator[](const char* key) const { return {document_, document_.member(value_, key)}; }
  Reader operator[](std::size_t i) const { return {document_, document_.array(value_)[i]}; }
  bool has(const char* key) const { return document_.find(value_, key) != nullptr; }
  std::size_t list_size() const { return document_.array(value_).size(); }
  double real() const { return document_.number(value_); }
  double real(double low, double high) const { return document_.number(value_, low, high); }
  int whole(int low, int high) const { return document_.integer(value_, low, high); }
  bool truth() const { return document_.boolean(value_); }
  const std::string& text() const { return document_.text(value_); }
  std::vector<double> reals() const {
    std::vector<double> out;
    for (std::size_t i = 0; i < list_size(); ++i) out.push_back((*this)[i].real());
    return out;
  }
  std::vector<double> reals(std::size_t count) const {
    document_.array(value_, count);
    return reals();
  }
  std::vector<int> wholes(std::size_t count, int low, int high) const {
    document_.array(value_, count);
    return wholes(low, high);
  }
  std::vector<int> wholes(int low, int high) const {
    std::vector<int> out;
    for (std::size_t i = 0; i < list_size(); ++i) out.push_back((*this)[i].whole(low, high));
    return out;
  }
  [[noreturn]] void fail(const std::string& reason) const { document_.fail(value_, reason); }

 private:
  const JsonDocument& document_;
  const Json& value_;
};

constexpr double kHuge = 1e9;
constexpr double kWidest = 1e4;     // px
constexpr double kLeastStep = 0.05;  // px; growth lays its grids by steps and spacings, which must not be all but nothing

Histogram read_histogram(const Reader& in) {
  Histogram h;
  h.low = in["low"].real();
  h.high = in["high"].real();
  if (!(h.high > h.low)) in.fail("'high' must exceed 'low'");
  const std::vector<double> counts = in["counts"].reals(kHistogramBins);
  std::copy(counts.begin(), counts.end(), h.counts.begin());
  h.total = in["total"].real(0.0, 1e15);
  return h;
}

std::array<Headings, kHeadingOrders> read_headings(const Reader& in) {
  std::array<Headings, kHeadingOrders> out;
  if (in.list_size() != kHeadingOrders) in.fail("a list of " + std::to_string(kHeadingOrders) + " is expected");
  for (std::size_t o = 0; o < out.size(); ++o) {
    const std::vector<double> share = in[o]["share"].reals(kHeadingBins);
    std::copy(share.begin(), share.end(), out[o].share.begin());
    out[o].strength = in[o]["strength"].real(0.0, 1.0 + 1e-9);
  }
  return out;
}

BendingModel read_bending(const Reader& in) {
  BendingModel m;
  m.step = in["step"].real(kLeastStep, kHuge);
  m.extension = in["extension"].whole(1, 1024);
  m.history = in["history"].whole(1, 4096);
  const Reader vertices = in["vertices"];
  for (std::size_t i = 0; i < vertices.list_size(); ++i) {
    const std::vector<double> v = vertices[i].reals(5);
    for (const double radius : {v[3], v[4]}) {
      if (!(radius > 0.0) || radius > kWidest) vertices[i].fail("radii must lie between 0 and " + number_text(kWidest));
    }
    m.point.emplace_back(v[0], v[1]);
    m.alpha.push_back(v[2]);
    m.radius.push_back(v[3]);
    m.smooth_radius.push_back(v[4]);
  }
  const Reader first = in["first"];
  m.first = first.wholes(0, m.vertex_count());
  const bool whole = m.first.size() >= 2 && m.first.front() == 0 && m.first.back() == m.vertex_count();
  if (!whole) first.fail("the branches must cover the vertices");
  for (int b = 0; b < m.branch_count(); ++b) {
    if (m.length_of(b) < 2) first.fail("branch " + std::to_string(b) + " has fewer than 2 vertices");
  }
  m.angle_gain = in["angle_gain"].real(1e-12, kHuge);
  m.radius_gain = in["radius_gain"].real(1e-12, kHuge);
  m.angles = read_histogram(in["angles"]);
  m.radii = read_histogram(in["radii"]);
  return m;
}

FurcationModel read_furcation(const Reader& in) {
  FurcationModel m;
  m.half_window = in["half_window"].whole(1, 4096);
  m.absolute_angles = in["absolute_angles"].truth();
  m.trained = in["trained"].truth();
  const std::size_t dims = in["weight"].list_size();
  if (dims != 0 && dims != static_cast<std::size_t>(4 * m.half_window + 4)) in["weight"].fail("4 k + 4 weights are expected");
  m.weight = in["weight"].reals();
  m.mean = in["mean"].reals(dims);
  m.deviation = in["deviation"].reals(dims);
  for (const double deviation : m.deviation) {
    if (!(deviation > 0.0)) in["deviation"].fail("deviations must be positive");
  }
  if (m.trained && dims == 0) in.fail("a trained model needs weights");
  m.bias = in["bias"].real();
  m.slope = in["slope"].real();
  m.offset = in["offset"].real();
  m.positives = in["positives"].whole(0, 1 << 30);
  m.auc = in["auc"].real(0.0, 1.0);
  m.auc_shape = in["auc_shape"].real(0.0, 1.0);
  m.gap_log_mean = in["gap_log_mean"].real(-20.0, 20.0);
  m.gap_log_deviation = in["gap_log_deviation"].real(0.0, 20.0);
  const std::vector<double> rate = in["rate"].reals(kHeadingOrders);
  std::copy(rate.begin(), rate.end(), m.rate.begin());
  return m;
}

SourceBranch read_branch(const Reader& in, const BendingModel& bending, int number) {
  SourceBranch b;
  b.parent = in["parent"].whole(kNone, number - 1);
  b.parent_vertex = in["parent_vertex"].whole(0, b.parent == kNone ? 0 : bending.length_of(b.parent) - 1);
  b.order = in["order"].whole(0, 1 << 20);
  b.tree = in["tree"].whole(0, 1 << 30);
  b.rim_angle = in["rim_angle"].real();
  b.start_angle = in["start_angle"].real();
  b.ratio = in["ratio"].real(1e-9, kHuge);
  b.starts_on_frame = in["starts_on_frame"].truth();
  b.starts_on_landmark = in.has("starts_on_landmark") && in["starts_on_landmark"].truth();  // styles of 0.1.0 lack it
  const std::string end = in["end"].text();
  const auto known = std::find(kEndNames.begin(), kEndNames.end(), end);
  if (known == kEndNames.end()) in["end"].fail("'tip', 'frame' or 'join' is expected");
  b.end = static_cast<BranchEnd>(known - kEndNames.begin());
  return b;
}

Hierarchy read_hierarchy(const Reader& in, const BendingModel& bending) {
  Hierarchy h;
  const Reader branches = in["branches"];
  if (branches.list_size() != static_cast<std::size_t>(bending.branch_count())) {
    branches.fail("as many branches as the bending model has are expected");
  }
  for (int b = 0; b < bending.branch_count(); ++b) h.branches.push_back(read_branch(branches[b], bending, b));
  h.headings = read_headings(in["headings"]);
  h.ray_headings = read_headings(in["ray_headings"]);
  h.lags = in["lags"].wholes(1, 1 << 20);
  h.lag_turn = in["lag_turn"].reals(h.lags.size());
  h.lag_chord = in.has("lag_chord") ? in["lag_chord"].reals(h.lags.size()) : std::vector<double>(h.lags.size(), 0.0);
  h.lag_winding =
      in.has("lag_winding") ? in["lag_winding"].reals(h.lags.size()) : std::vector<double>(h.lags.size(), kHuge);
  h.tip_profile = in["tip_profile"].reals(static_cast<std::size_t>(2 * bending.extension + 1));
  h.least_radius = in["least_radius"].real(1e-9, kHuge);
  h.side_gap = in["side_gap"].whole(1, 1 << 20);
  h.highest_order = in["highest_order"].whole(0, 1 << 20);
  h.most_ratio = in["most_ratio"].real(1e-3, 1e3);
  h.spacing = in["spacing"].real(kLeastStep, kHuge);
  if (in.has("clearance")) {  // styles of the first days know nothing of the room between branches
    h.clearance = in["clearance"].real(0.0, kHuge);
    h.opening = in["opening"].real(0.0, 1.0);
    const std::vector<double> chord_spread = in["chord_spread"].reals(kHeadingOrders);
    std::copy(chord_spread.begin(), chord_spread.end(), h.chord_spread.begin());
  } else {
    h.chord_spread.fill(kPi);
  }
  h.total_length = in["total_length"].real(0.0, 1e15);
  h.furcation_gap = in["furcation_gap"].whole(1, 1 << 20);
  h.habitat = in["habitat"].reals(kHabitatCells * kHabitatCells);
  return h;
}

}  // namespace

std::string style_text(const Style& style) {
  return json_text(Json::Object{{"format", kFormat},
                  {"version", kVersion},
                  {"step", style.step},
                  {"feature_size", style.feature_size},
                  {"unit_radius", style.unit_radius},
                  {"mirror", style.mirror},
                  {"exemplar_size", Json::Array{style.exemplar_size.width, style.exemplar_size.height}},
                  {"bending", bending_json(style.bending)},
                  {"furcation", furcation_json(style.furcation)},
                  {"hierarchy", hierarchy_json(style.hierarchy)}});
}

Style parse_style(const std::string& json, const std::string& name) {
  const JsonDocument document(json, name);
  document.check_format(kFormat, kVersion);
  const Reader in(document, document.root());
  Style style;
  style.step = in["step"].real(kLeastStep, kHuge);
  style.feature_size = in["feature_size"].real(kLeastStep, kHuge);
  style.unit_radius = in["unit_radius"].real(1e-9, kHuge);
  style.mirror = in["mirror"].truth();
  const std::vector<int> size = in["exemplar_size"].wholes(2, 1, 1 << 20);
  style.exemplar_size = {size[0], size[1]};
  style.bending = read_bending(in["bending"]);
  style.furcation = read_furcation(in["furcation"]);
  style.hierarchy = read_hierarchy(in["hierarchy"], style.bending);
  return style;
}

}  // namespace ramify
