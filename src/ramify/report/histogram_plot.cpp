// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/report/histogram_plot.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "ramify/core/error.h"

namespace ramify {
namespace {

constexpr int kColumns = 2;
constexpr double kWidth = 420.0, kHeight = 220.0;                            // of one plot
constexpr double kLeft = 52.0, kRight = 12.0, kTop = 34.0, kBottom = 36.0;   // margins
constexpr double kLegend = 30.0;

std::string place(double x, double y) { return figure_text(x) + "," + figure_text(y); }

std::string text_at(double x, double y, const char* anchor, const std::string& text) {
  return "<text x=\"" + figure_text(x) + "\" y=\"" + figure_text(y) + "\" text-anchor=\"" + anchor + "\">" + xml_text(text) + "</text>\n";
}

std::string one_plot(const HistogramFigure& figure, double x0, double y0) {
  const std::size_t bins = figure.exemplar.shares.size();
  double top = 0.0;
  for (std::size_t i = 0; i < bins; ++i) top = std::max({top, figure.exemplar.shares[i], figure.result.shares[i]});
  const double w = kWidth - kLeft - kRight, h = kHeight - kTop - kBottom, base = y0 + kTop + h;
  const auto x_of = [&](std::size_t bin) { return x0 + kLeft + w * static_cast<double>(bin) / static_cast<double>(bins); };
  const auto y_of = [&](double share) { return base - (top > 0.0 ? h * share / top : 0.0); };
  std::string fill = "M" + place(x_of(0), base), line;
  for (std::size_t i = 0; i < bins; ++i) {
    fill += " L" + place(x_of(i), y_of(figure.exemplar.shares[i])) + " L" + place(x_of(i + 1), y_of(figure.exemplar.shares[i]));
    line += std::string(i == 0 ? "M" : " L") + place(x_of(i), y_of(figure.result.shares[i])) + " L" +
            place(x_of(i + 1), y_of(figure.result.shares[i]));
  }
  std::string out = "<path class=\"exemplar\" d=\"" + fill + " L" + place(x_of(bins), base) + "Z\"/>\n<path class=\"result\" d=\"" +
                    line + "\"/>\n<path class=\"axis\" d=\"M" + place(x0 + kLeft, y0 + kTop) + " V" + figure_text(base) + " H" +
                    figure_text(x0 + kLeft + w) + "\"/>\n";
  out += text_at(x0 + kLeft + w / 2, y0 + 20, "middle", figure.label + (figure.unit.empty() ? "" : " (" + figure.unit + ")"));
  out += text_at(x0 + kLeft, base + 18, "middle", figure_text(figure.exemplar.low));
  out += text_at(x0 + kLeft + w, base + 18, "end", figure_text(figure.exemplar.high));
  out += text_at(x0 + kLeft - 6, y_of(top) + 4, "end", std::to_string(std::lround(100.0 * top)) + " %");
  return out + text_at(x0 + kLeft - 6, base, "end", "0");
}

}  // namespace

std::string figure_text(double value) {
  if (!std::isfinite(value)) return "-";
  char buffer[400];
  const bool whole = std::abs(value) >= 1000.0;
  const auto end = whole ? std::to_chars(buffer, buffer + sizeof buffer, std::round(value), std::chars_format::fixed, 0).ptr
                         : std::to_chars(buffer, buffer + sizeof buffer, value + 0.0, std::chars_format::general, 4).ptr;
  return std::string(buffer, end);
}

std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : printable(text, 400)) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\'': out += "&#39;"; break;
      default: out += c;
    }
  }
  return out;
}

std::string histogram_plots(const std::vector<HistogramFigure>& figures, const std::string& exemplar_name,
                            const std::string& result_name) {
  const int rows = (static_cast<int>(figures.size()) + kColumns - 1) / kColumns;
  const std::string w = figure_text(kColumns * kWidth), h = figure_text(kLegend + rows * kHeight);
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h + "\" viewBox=\"0 0 " + w + " " + h +
                    "\" role=\"img\" font-family=\"sans-serif\" font-size=\"12\">\n<style>.exemplar{fill:#9db7cf}"
                    ".result{fill:none;stroke:#b5442e;stroke-width:2}.axis{fill:none;stroke:#555}</style>\n"
                    "<rect width=\"" + w + "\" height=\"" + h + "\" fill=\"#fff\"/>\n"
                    "<rect class=\"exemplar\" x=\"48\" y=\"9\" width=\"22\" height=\"12\"/><path class=\"result\" d=\"M448 15h22\"/>\n";
  out += text_at(76, 20, "start", exemplar_name) + text_at(476, 20, "start", result_name);
  for (std::size_t i = 0; i < figures.size(); ++i) {
    out += one_plot(figures[i], kWidth * static_cast<double>(i % kColumns), kLegend + kHeight * static_cast<double>(i / kColumns));
  }
  return out + "</svg>\n";
}

}  // namespace ramify
