// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/recipe_xmp.h"

#include <array>
#include <string_view>
#include <utility>

namespace ramify {
namespace {

constexpr std::string_view kOpen =
    "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">"
    "<rdf:Description rdf:about=\"\" xmlns:ramify=\"urn:ramify:1\"><ramify:recipe>";
constexpr std::string_view kClose = "</ramify:recipe></rdf:Description></rdf:RDF></x:xmpmeta>";
constexpr std::string_view kOpenElement = "<ramify:recipe>", kCloseElement = "</ramify:recipe>";

constexpr std::array<std::pair<char, std::string_view>, 4> kEscapes{
    {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'\r', "&#13;"}}};

}  // namespace

std::string xmp_of_recipe(const std::string& recipe) {
  if (recipe.empty()) return {};
  std::string out(kOpen);
  for (const char c : recipe) {
    std::string_view written(&c, 1);
    for (const auto& [plain, escaped] : kEscapes) written = c == plain ? escaped : written;
    out += written;
  }
  return out.append(kClose);
}

std::string recipe_of_xmp(const std::string& xmp) {
  const std::size_t open = xmp.find(kOpenElement);
  const std::size_t close = xmp.rfind(kCloseElement);
  if (open == std::string::npos || close == std::string::npos || close < open) return {};
  const std::size_t begin = open + kOpenElement.size();
  std::string out;
  for (std::size_t at = begin; at < close;) {
    std::size_t length = 1;
    char c = xmp[at];
    for (const auto& [plain, escaped] : kEscapes) {
      if (xmp.compare(at, escaped.size(), escaped) == 0) c = plain, length = escaped.size();
    }
    out += c;
    at += length;
  }
  return out;
}

}  // namespace ramify
