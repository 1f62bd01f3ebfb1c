// SPDX-License-Identifier: GPL-3.0-or-later
// The report as one HTML file: no script, nothing loaded from elsewhere, readable in print and in the dark.
#include <cstdint>

#include "ramify/image/image_io.h"
#include "ramify/report/histogram_plot.h"
#include "ramify/report/report.h"

namespace ramify {
namespace {

const char* const kHead =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\n"
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'\">\n"
    "<style>\n"
    "body{font:16px/1.45 system-ui,sans-serif;max-width:66rem;margin:2rem auto;padding:0 1rem;color:#222;background:#fff}\n"
    "h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2.2rem}\n"
    "table{border-collapse:collapse;width:100%}th,td{padding:.25rem .6rem;text-align:right;border-bottom:1px solid #ddd}\n"
    "th:first-child,td:first-child,td.limit,th.limit{text-align:left}td.limit{color:#555}\n"
    ".pass{color:#1d6b3a}.fail{color:#a4262c;font-weight:600}\n"
    "figure{margin:0}figcaption{color:#555;font-size:.9rem}img,svg{max-width:100%;height:auto}\n"
    ".pair{display:grid;grid-template-columns:1fr 1fr;gap:1rem}.crops{display:flex;flex-wrap:wrap;gap:1rem}\n"
    ".crops img{image-rendering:pixelated}\n"
    "@media(prefers-color-scheme:dark){body{background:#1b1d20;color:#e4e4e4}th,td{border-color:#3a3d42}"
    "td.limit,figcaption{color:#aaa}.pass{color:#7ccf95}.fail{color:#ff8d85}}\n"
    "</style>\n";

std::string base64(const std::string& bytes) {
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63u];
  }
  return out;
}

std::string picture(const ReportPicture& shown, const char* extension, const char* type) {
  SaveOptions options;
  options.quality = 85;
  const std::string bytes = encode_image(std::string("picture") + extension, shown.image, nullptr, options);
  const std::string caption = xml_text(shown.caption);
  return "<figure><img alt=\"" + caption + "\" width=\"" + std::to_string(shown.image.width()) + "\" height=\"" +
         std::to_string(shown.image.height()) + "\" src=\"data:" + type + ";base64," + base64(bytes) + "\"><figcaption>" + caption +
         "</figcaption></figure>\n";
}

std::string cell(const std::optional<double>& value) {
  return "<td>" + (value ? figure_text(*value) : std::string()) + "</td>";
}

std::string table(const std::string& title, const std::vector<Figure>& figures) {
  std::string out = "<h2>" + title + "</h2>\n<table><thead><tr><th>figure</th><th>exemplar</th><th>result</th>"
                    "<th title=\"between parts of the exemplar\">spread</th><th class=\"limit\">passes when</th><th></th></tr></thead><tbody>\n";
  for (const Figure& f : figures) {
    const char* const mark = f.verdict == Verdict::Pass   ? "<td class=\"pass\">pass</td>"
                             : f.verdict == Verdict::Fail ? "<td class=\"fail\">fail</td>"
                                                          : "<td></td>";
    out += "<tr><td>" + xml_text(f.label + (f.unit.empty() ? "" : " (" + f.unit + ")")) + "</td>" + cell(f.exemplar) + cell(f.result) +
           cell(f.spread) + "<td class=\"limit\">" + xml_text(f.limit) + "</td>" + mark + "</tr>\n";
  }
  return out + "</tbody></table>\n";
}

}  // namespace

std::string report_html(const Report& report) {
  const int failed = failures(report);
  const std::string title = xml_text(report.result_name) + " beside " + xml_text(report.exemplar_name);
  std::string out = std::string(kHead) + "<title>" + title + "</title></head><body>\n<h1>" + title + "</h1>\n<p>" +
                    (failed == 0 ? "No figure is outside its limit."
                                 : std::to_string(failed) + (failed == 1 ? " figure is" : " figures are") + " outside the limit.") +
                    " Spread is what parts of the exemplar differ by among themselves: a result need not come closer.</p>\n";
  if (!report.pictures.empty()) {
    out += "<div class=\"pair\">\n";
    for (const ReportPicture& p : report.pictures) out += picture(p, ".jpg", "image/jpeg");
    out += "</div>\n";
  }
  if (!report.histograms.empty()) {
    out += "<h2>Histograms</h2>\n" + histogram_plots(report.histograms, report.exemplar_name, report.result_name);
  }
  if (!report.structure.empty()) out += table("Structure", report.structure);
  if (!report.picture.empty()) out += table("Picture", report.picture);
  if (!report.crops.empty()) {
    out += "<h2>Worst seams</h2>\n<div class=\"crops\">\n";
    for (const ReportPicture& p : report.crops) out += picture(p, ".png", "image/png");
    out += "</div>\n";
  }
  return out + "</body></html>\n";
}

}  // namespace ramify
