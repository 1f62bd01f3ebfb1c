// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/paint/lettering.h"

#include <fontconfig/fontconfig.h>
#include <ft2build.h>
#include <hb-ft.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "ramify/core/error.h"
#include "ramify/paint/drawing.h"

namespace ramify {
namespace fs = std::filesystem;
namespace {

template <class T, class Free>
std::unique_ptr<T, Free> owned(T* pointer, Free free) { return {pointer, free}; }

// Code points; empty when the bytes are no UTF-8.
std::vector<char32_t> decode_utf8(const std::string& text) {
  std::vector<char32_t> out;
  for (std::size_t i = 0; i < text.size();) {
    const unsigned char lead = static_cast<unsigned char>(text[i]);
    const int more = lead < 0x80 ? 0 : lead >= 0xC2 && lead < 0xE0 ? 1 : lead >= 0xE0 && lead < 0xF0 ? 2 : lead >= 0xF0 && lead < 0xF5 ? 3 : -1;
    if (more < 0 || i + static_cast<std::size_t>(more) >= text.size()) return {};
    char32_t code = more == 0 ? lead : lead & (0x3F >> more);
    for (int k = 1; k <= more; ++k) {
      const unsigned char next = static_cast<unsigned char>(text[i + static_cast<std::size_t>(k)]);
      if ((next & 0xC0) != 0x80) return {};
      code = (code << 6) | (next & 0x3F);
    }
    const bool overlong = (more == 2 && code < 0x800) || (more == 3 && code < 0x10000);
    if (overlong || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return {};
    out.push_back(code);
    i += static_cast<std::size_t>(more) + 1;
  }
  return out;
}

// FreeType hands over an outline move by move; y points up there.
struct Tracer {
  std::vector<std::vector<CubicBezier>> loops;
  Vec2 origin, at;
  double scale;

  Vec2 place(const FT_Vector* v) const { return origin + scale * Vec2(v->x, -v->y); }
  static int move(const FT_Vector* to, void* self) {
    auto& t = *static_cast<Tracer*>(self);
    t.close();
    t.at = t.place(to);
    t.loops.emplace_back();
    return 0;
  }
  static int line(const FT_Vector* to, void* self) {
    auto& t = *static_cast<Tracer*>(self);
    t.add(straight_bezier(t.at, t.place(to)));
    return 0;
  }
  static int conic(const FT_Vector* c, const FT_Vector* to, void* self) {
    auto& t = *static_cast<Tracer*>(self);
    const Vec2 control = t.place(c), end = t.place(to);
    t.add({t.at, t.at + 2.0 / 3.0 * (control - t.at), end + 2.0 / 3.0 * (control - end), end});
    return 0;
  }
  static int cubic(const FT_Vector* a, const FT_Vector* b, const FT_Vector* to, void* self) {
    auto& t = *static_cast<Tracer*>(self);
    t.add({t.at, t.place(a), t.place(b), t.place(to)});
    return 0;
  }
  void add(const CubicBezier& curve) {
    loops.back().push_back(curve);
    at = curve[3];
  }
  void close() {
    if (!loops.empty() && !loops.back().empty() && (at - loops.back().front()[0]).norm() > 1e-9) add(straight_bezier(at, loops.back().front()[0]));
  }
};

class Setter {
 public:
  Setter(const std::string& file, double height) : file_(printable(file, 300)) {
    if (FT_Init_FreeType(&library_) != 0) throw InputError(file_, "FreeType cannot start");
    if (FT_New_Face(library_, file.c_str(), 0, &face_) != 0 || !FT_IS_SCALABLE(face_)) {
      if (face_) FT_Done_Face(face_);
      FT_Done_FreeType(library_);
      throw InputError(file_, "is no font with outlines; name a .ttf or .otf file");
    }
    scale_ = height / face_->units_per_EM;
    FT_Set_Char_Size(face_, 0, static_cast<FT_F26Dot6>(face_->units_per_EM) * 64, 72, 72);  // one unit = 1 px while setting
  }
  ~Setter() {
    FT_Done_Face(face_);
    FT_Done_FreeType(library_);
  }
  Setter(const Setter&) = delete;
  Setter& operator=(const Setter&) = delete;

  double line_height() const { return scale_ * face_->height; }

  // One line with its pen starting at the origin; returns the loops.
  std::vector<std::vector<CubicBezier>> set_line(const std::string& text) {
    const auto buffer = owned(hb_buffer_create(), hb_buffer_destroy);
    hb_buffer_add_utf8(buffer.get(), text.data(), static_cast<int>(text.size()), 0, -1);
    hb_buffer_guess_segment_properties(buffer.get());
    const auto font = owned(hb_ft_font_create_referenced(face_), hb_font_destroy);
    hb_ft_font_set_load_flags(font.get(), FT_LOAD_NO_HINTING);
    hb_shape(font.get(), buffer.get(), nullptr, 0);
    unsigned count = 0;
    const hb_glyph_info_t* glyphs = hb_buffer_get_glyph_infos(buffer.get(), &count);
    const hb_glyph_position_t* places = hb_buffer_get_glyph_positions(buffer.get(), &count);
    Tracer tracer{{}, Vec2::Zero(), Vec2::Zero(), scale_ / 64.0};
    Vec2 pen = Vec2::Zero();
    for (unsigned i = 0; i < count; ++i) {
      if (glyphs[i].codepoint == 0) missing(text, glyphs[i].cluster);
      if (FT_Load_Glyph(face_, glyphs[i].codepoint, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) != 0) throw InputError(file_, "a glyph cannot be read");
      tracer.origin = pen + scale_ / 64.0 * Vec2(places[i].x_offset, -places[i].y_offset);
      const FT_Outline_Funcs functions{Tracer::move, Tracer::line, Tracer::conic, Tracer::cubic, 0, 0};
      if (FT_Outline_Decompose(&face_->glyph->outline, &functions, &tracer) != 0) throw InputError(file_, "an outline cannot be read");
      tracer.close();
      pen += scale_ / 64.0 * Vec2(places[i].x_advance, -places[i].y_advance);
    }
    std::erase_if(tracer.loops, [](const auto& loop) { return loop.empty(); });
    return std::move(tracer.loops);
  }

 private:
  [[noreturn]] void missing(const std::string& text, unsigned cluster) const {
    const std::vector<char32_t> code = decode_utf8(text.substr(cluster, 4));
    const std::vector<char32_t> one = code.empty() ? decode_utf8(text.substr(cluster)) : code;
    char number[16];
    std::snprintf(number, sizeof number, "U+%04X", one.empty() ? 0u : static_cast<unsigned>(one.front()));
    throw InputError(file_, "has no sign for the character " + std::string(number) + " of the text; choose another --font");
  }

  std::string file_;
  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
  double scale_ = 1.0;
};

}  // namespace

std::string find_font(const std::string& font) {
  std::error_code error;
  if (font.find('/') != std::string::npos || fs::is_regular_file(font, error)) {
    if (fs::is_regular_file(font, error)) return font;
    throw InputError(printable(font, 300), "there is no such font file");
  }
  const auto pattern = owned(FcNameParse(reinterpret_cast<const FcChar8*>(font.c_str())), FcPatternDestroy);
  if (!pattern) throw OptionError("font", "'" + printable(font, 100) + "'", "expected a name such as \"DejaVu Serif:bold\" or a font file");
  FcChar8* wanted = nullptr;
  const bool named = FcPatternGetString(pattern.get(), FC_FAMILY, 0, &wanted) == FcResultMatch;
  const std::string family = named ? reinterpret_cast<const char*>(wanted) : "";
  FcConfigSubstitute(nullptr, pattern.get(), FcMatchPattern);
  FcDefaultSubstitute(pattern.get());
  FcResult result = FcResultNoMatch;
  const auto match = owned(FcFontMatch(nullptr, pattern.get(), &result), FcPatternDestroy);
  FcChar8 *file = nullptr, *found = nullptr;
  if (!match || FcPatternGetString(match.get(), FC_FILE, 0, &file) != FcResultMatch) {
    throw InputError("", "no font is installed; name a .ttf or .otf file with --font");
  }
  FcPatternGetString(match.get(), FC_FAMILY, 0, &found);
  const std::string got = found ? reinterpret_cast<const char*>(found) : "";
  const bool generic = family.empty() || family == "serif" || family == "sans-serif" || family == "sans" || family == "monospace";
  if (!generic && FcStrCmpIgnoreCase(reinterpret_cast<const FcChar8*>(family.c_str()), reinterpret_cast<const FcChar8*>(got.c_str())) != 0) {
    throw InputError("", "the font " + printable(family, 100) + " is not installed; the nearest is " + printable(got, 100) + " (--font also takes a file)");
  }
  return reinterpret_cast<const char*>(file);
}

Lettering set_text(const std::string& text, const std::string& font_file, double height) {
  if (text.find_first_not_of(" \n\t") == std::string::npos) throw OptionError("text", "", "is empty; name the text to draw");
  if (text.size() > 10000) throw OptionError("text", "", "is longer than 10000 bytes");
  if (decode_utf8(text).empty()) throw OptionError("text", "'" + printable(text, 60) + "'", "is not UTF-8");
  Setter setter(font_file, height);
  Lettering out;
  std::vector<std::vector<std::vector<CubicBezier>>> lines;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(setter.set_line(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  double widest = 0.0;
  std::vector<std::pair<double, double>> ink;
  for (const auto& line : lines) {
    double from = 1e9, to = -1e9;
    for (const auto& loop : line) {
      for (const CubicBezier& curve : loop) {
        for (const Vec2& p : curve) from = std::min(from, p.x()), to = std::max(to, p.x());
      }
    }
    if (from > to) from = to = 0.0;
    ink.emplace_back(from, to);
    widest = std::max(widest, to - from);
  }
  double low = 1e9, high = -1e9;
  const double margin = height / 6.0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Vec2 shift(margin + 0.5 * (widest - (ink[i].second - ink[i].first)) - ink[i].first, static_cast<double>(i) * setter.line_height());
    out.baselines.push_back(shift.y());
    out.extents.emplace_back(ink[i].first + shift.x(), ink[i].second + shift.x());
    for (auto& loop : lines[i]) {
      for (CubicBezier& curve : loop) {
        for (Vec2& p : curve) p += shift, low = std::min(low, p.y()), high = std::max(high, p.y());
      }
      out.loops.push_back(std::move(loop));
    }
  }
  if (out.loops.empty()) throw OptionError("text", "", "has no visible character");
  for (auto& loop : out.loops) {
    for (CubicBezier& curve : loop) {
      for (Vec2& p : curve) p.y() += margin - low;
    }
  }
  for (double& baseline : out.baselines) baseline += margin - low;
  out.size = {static_cast<int>(std::ceil(widest + 2 * margin)), static_cast<int>(std::ceil(high - low + 2 * margin))};
  return out;
}

Mask text_mask(const Lettering& lettering) {
  Drawing drawing;
  drawing.size = lettering.size;
  drawing.layers.push_back({"text", {{lettering.loops, Rgb{}, 1.0}}});
  Mask mask = rasterize(drawing, {lettering.size}, Monitor()).alpha;
  for (std::uint8_t& value : mask.pixels()) value = value >= 128 ? 255 : 0;
  return mask;
}

}  // namespace ramify
