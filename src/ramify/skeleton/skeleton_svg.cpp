// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "ramify/core/json.h"
#include "ramify/core/options.h"
#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/skeleton_io.h"

namespace ramify {
namespace {

// Three decimals: a thousandth of a pixel, and files a third as long.
std::string short_number(double value) { return number_text(std::round(value * 1000.0) / 1000.0 + 0.0); }
std::string point_text(const Vec2& p) { return short_number(p.x() + 0.5) + " " + short_number(p.y() + 0.5); }

std::string centre_path(const Skeleton& skeleton, const Branch& branch, int index) {
  std::string d, radii;
  if (branch.parent_node != kNone) d = point_text(skeleton[branch.parent_node].xy());
  for (const int i : branch.nodes) {
    d += (d.empty() ? "" : " ") + point_text(skeleton[i].xy());
    radii += (radii.empty() ? "" : " ") + short_number(skeleton[i].radius);
  }
  std::string out = "<path id=\"branch" + std::to_string(index) + "\" ";
  if (branch.parent_node != kNone) out += "data-parent=\"" + std::to_string(branch.parent_node) + "\" ";
  out += "data-nodes=\"";
  for (std::size_t k = 0; k < branch.nodes.size(); ++k) out += (k > 0 ? " " : "") + std::to_string(branch.nodes[k]);
  return out + "\" data-radii=\"" + radii + "\" d=\"M" + d + "\"/>\n";
}

void append_disc(const Vec2& centre, double radius, std::string& d) {
  const std::string r = short_number(radius);
  d += "M" + point_text(centre - Vec2(radius, 0)) + "a" + r + " " + r + " 0 1 1 " + short_number(2 * radius) + " 0a" + r +
       " " + r + " 0 1 1 " + short_number(-2 * radius) + " 0z";
}

// The sides of a round cone: the quadrilateral between the points where the common tangents touch both circles. Turns the
// same way as the discs, so that the non-zero rule fills the union.
void append_sides(const Vec2& a, double ra, const Vec2& b, double rb, std::string& d) {
  const Vec2 edge = b - a;
  const double length = edge.norm();
  if (length <= std::abs(ra - rb)) return;  // one disc holds the other
  const Vec2 along = edge / length;
  const double cosine = (ra - rb) / length, sine = std::sqrt(1.0 - cosine * cosine);
  const Vec2 left = cosine * along - sine * perpendicular(along), right = cosine * along + sine * perpendicular(along);
  d += "M" + point_text(a + ra * left) + "L" + point_text(b + rb * left) + "L" + point_text(b + rb * right) + "L" +
       point_text(a + ra * right) + "z";
}

std::string outline_path(const Skeleton& skeleton, const Branch& branch) {
  const Polyline line = branch_polyline(skeleton, branch);
  std::string d;
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    append_disc(line.points[i], line.radii[i], d);
    if (i > 0) append_sides(line.points[i - 1], line.radii[i - 1], line.points[i], line.radii[i], d);
  }
  return "<path d=\"" + d + "\"/>\n";
}

}  // namespace

std::string svg_text(const Skeleton& skeleton) {
  const BranchTree tree = branch_tree(skeleton);
  const std::string w = std::to_string(skeleton.size.width), h = std::to_string(skeleton.size.height);
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
                    "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"" + w + "\" height=\"" + h +
                    "\" viewBox=\"0 0 " + w + " " + h + "\">\n"
                    "<g id=\"outlines\" inkscape:groupmode=\"layer\" inkscape:label=\"outlines\" fill=\"#7a8fa6\" "
                    "stroke=\"none\" fill-rule=\"nonzero\">\n";
  for (const Branch& branch : tree.branches) out += outline_path(skeleton, branch);
  out += "</g>\n<g id=\"centre-lines\" inkscape:groupmode=\"layer\" inkscape:label=\"centre lines\" fill=\"none\" "
         "stroke=\"#c0392b\" stroke-width=\"1\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n";
  for (std::size_t b = 0; b < tree.branches.size(); ++b) out += centre_path(skeleton, tree.branches[b], static_cast<int>(b));
  for (const auto& [a, b] : skeleton.loop_links) {
    out += "<path class=\"loop\" data-loop=\"" + std::to_string(a) + " " + std::to_string(b) + "\" d=\"M" +
           point_text(skeleton[a].xy()) + " " + point_text(skeleton[b].xy()) + "\"/>\n";
  }
  return out + "</g>\n</svg>\n";
}

std::string geojson_text(const Skeleton& skeleton) {
  const BranchTree tree = branch_tree(skeleton);
  Json::Array features;
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const Branch& branch = tree.branches[b];
    const Polyline line = branch_polyline(skeleton, branch);
    Json::Array coordinates, radii;
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      coordinates.push_back(Json::Array{line.points[i].x() + 0.5, line.points[i].y() + 0.5});
      radii.push_back(line.radii[i]);
    }
    // A LineString needs two positions (RFC 7946): a branch of one node becomes a Point.
    const bool single = coordinates.size() == 1;
    Json geometry(Json::Object{{"type", single ? "Point" : "LineString"},
                               {"coordinates", single ? coordinates.front() : Json(coordinates)}});
    Json properties(Json::Object{{"branch", static_cast<int>(b)}, {"parent", branch.parent}, {"order", branch.order},
                                 {"length_px", branch.length}, {"radii_px", std::move(radii)}});
    features.push_back(Json::Object{{"type", "Feature"}, {"properties", std::move(properties)}, {"geometry", std::move(geometry)}});
  }
  return json_text(Json::Object{{"type", "FeatureCollection"}, {"features", std::move(features)}});
}

}  // namespace ramify
