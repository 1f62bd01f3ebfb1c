// SPDX-License-Identifier: GPL-3.0-or-later
// Cairo says how much of every pixel a shape covers; colours are mixed here in float, so that 16-bit pictures have smooth
// edges and light can be added in linear light.
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"
#include "ramify/paint/drawing.h"
#include "ramify/paint/exposure.h"
#include "ramify/paint/wash.h"

namespace ramify {
namespace {

constexpr int kBand = 128;  // rows drawn at a time; independent of the number of threads

struct Box {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // px, x1 and y1 beyond the last
  bool empty() const { return x0 >= x1 || y0 >= y1; }
};

Box intersection(const Box& a, const Box& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

// In picture coordinates whose pixel (0,0) covers [0,1) x [0,1), as cairo has it.
struct View {
  double scale;
  Vec2 shift;
  Vec2 operator()(const Vec2& p) const { return scale * (p + Vec2(0.5, 0.5)) + shift; }
};

Box box_of(const Shape& shape, const View& view) {
  Vec2 low(1e9, 1e9), high(-1e9, -1e9);
  for (const auto& loop : shape.loops) {
    for (const CubicBezier& curve : loop) {
      for (const Vec2& p : curve) low = low.cwiseMin(view(p)), high = high.cwiseMax(view(p));
    }
  }
  if (low.x() > high.x()) return {};
  const auto whole = [](double v) { return static_cast<int>(std::clamp(v, -1e8, 1e8)); };
  return {whole(std::floor(low.x())) - 1, whole(std::floor(low.y())) - 1, whole(std::ceil(high.x())) + 1, whole(std::ceil(high.y())) + 1};
}

using Surface = std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)>;
using Context = std::unique_ptr<cairo_t, void (*)(cairo_t*)>;

// Calls paint(x, y, share of the pixel that the shape covers, 0..1) for covered pixels of the box.
template <class Paint>
void cover(const Shape& shape, const View& view, const Box& box, const Paint& paint) {
  const int width = box.x1 - box.x0, height = box.y1 - box.y0;
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, width, height), cairo_surface_destroy);
  const Context context(cairo_create(surface.get()), cairo_destroy);
  if (cairo_status(context.get()) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
  cairo_set_antialias(context.get(), CAIRO_ANTIALIAS_BEST);
  cairo_set_tolerance(context.get(), 0.05);
  cairo_set_fill_rule(context.get(), CAIRO_FILL_RULE_WINDING);
  const Vec2 corner(box.x0, box.y0);
  for (const auto& loop : shape.loops) {
    if (loop.empty()) continue;
    const Vec2 start = view(loop.front()[0]) - corner;
    cairo_move_to(context.get(), start.x(), start.y());
    for (const CubicBezier& curve : loop) {
      const Vec2 a = view(curve[1]) - corner, b = view(curve[2]) - corner, c = view(curve[3]) - corner;
      cairo_curve_to(context.get(), a.x(), a.y(), b.x(), b.y(), c.x(), c.y());
    }
    cairo_close_path(context.get());
  }
  cairo_fill(context.get());
  cairo_surface_flush(surface.get());
  const unsigned char* bytes = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const unsigned char level = bytes[static_cast<std::ptrdiff_t>(y) * stride + x];
      if (level != 0) paint(box.x0 + x, box.y0 + y, static_cast<float>(level) / 255.0f);
    }
  }
}

// Colour multiplied by opacity, and opacity.
struct Premultiplied {
  Rgb color;
  float alpha = 0.0f;
};

struct BandShape {
  const Shape* shape;
  Box box;
};

// Shapes that are laid over what is there with one opacity, or the density of what is washed over it.
struct BandLayer {
  std::vector<BandShape> shapes;
  float opacity = 1.0f;
  ColorImage density;
};

std::vector<BandShape> shapes_with_boxes(std::span<const Layer> layers, Blend blend, const View& view) {
  std::vector<BandShape> out;
  for (const Layer& layer : layers) {
    if (layer.blend != blend) continue;
    for (const Shape& shape : layer.shapes) out.push_back({&shape, box_of(shape, view)});
  }
  return out;
}

void paint_band(const std::vector<BandShape>& shapes, const View& view, const Box& band, Image<Premultiplied>& pixels) {
  for (const BandShape& item : shapes) {
    const Box box = intersection(item.box, band);
    if (box.empty()) continue;
    const Rgb color = item.shape->color;
    const float opacity = static_cast<float>(item.shape->opacity);
    cover(*item.shape, view, box, [&](int x, int y, float share) {
      Premultiplied& p = pixels(x, y - band.y0);
      const float a = opacity * share;
      p.color = (1.0f - a) * p.color + a * color;
      p.alpha = (1.0f - a) * p.alpha + a;
    });
  }
}

// Transparent pigment. Without a ground, the opacity that shows the same on white.
Premultiplied washed(const Premultiplied& below, const Rgb& density) {
  const Rgb kept{std::exp(-density.r), std::exp(-density.g), std::exp(-density.b)};
  const float least = std::min({kept.r, kept.g, kept.b});
  const float alpha = 1.0f - (1.0f - below.alpha) * least;
  Premultiplied out{{}, alpha};
  for (int k = 0; k < 3; ++k) out.color[k] = (below.color[k] + 1.0f - below.alpha) * kept[k] - (1.0f - alpha);
  return out;
}

void paint_layer(const BandLayer& layer, const View& view, const Box& band, Image<Premultiplied>& pixels) {
  if (!layer.density.empty()) {
    for (int y = band.y0; y < band.y1; ++y) {
      for (int x = band.x0; x < band.x1; ++x)
        pixels(x, y - band.y0) = washed(pixels(x, y - band.y0), layer.density(x, y));
    }
    return;
  }
  if (layer.opacity >= 1.0f) {
    paint_band(layer.shapes, view, band, pixels);
    return;
  }
  Image<Premultiplied> own(pixels.size());
  paint_band(layer.shapes, view, band, own);
  for (std::size_t i = 0; i < own.pixels().size(); ++i) {
    const Premultiplied& top = own.pixels()[i];
    Premultiplied& p = pixels.pixels()[i];
    const float keep = 1.0f - layer.opacity * top.alpha;
    p = {keep * p.color + layer.opacity * top.color, keep * p.alpha + layer.opacity * top.alpha};
  }
}

ColorImage density_of(const Layer& layer, const RasterOptions& options, const View& view, const Monitor& monitor) {
  WetLayer wet{ColorImage(options.size), ScalarImage(options.size), layer.blur};
  const std::vector<BandShape> shapes = shapes_with_boxes({&layer, 1}, Blend::Wash, view);
  const int bands = (options.size.height + kBand - 1) / kBand;
  parallel_for(bands, [&](int b) {
    monitor.check();
    const Box band{0, b * kBand, options.size.width, std::min(options.size.height, (b + 1) * kBand)};
    Image<Premultiplied> pixels(options.size.width, band.y1 - band.y0);
    paint_band(shapes, view, band, pixels);
    for (int y = band.y0; y < band.y1; ++y) {
      for (int x = 0; x < options.size.width; ++x) {
        wet.color(x, y) = pixels(x, y - band.y0).color;
        wet.alpha(x, y) = pixels(x, y - band.y0).alpha;
      }
    }
  });
  ColorImage density = optical_density(wet, {options.scale, options.shift}, monitor);
  for (Rgb& d : density.pixels()) d = static_cast<float>(layer.opacity) * d;
  return density;
}

// Light of all Add layers, linear.
ColorImage emitted_light(const Drawing& drawing, const RasterOptions& options, const View& view, const Monitor& monitor) {
  ColorImage light;
  for (const Layer& layer : drawing.layers) {
    if (layer.blend != Blend::Add) continue;
    if (light.empty()) light = ColorImage(options.size);
    monitor.check();
    ColorImage own(options.size);
    const std::vector<BandShape> shapes = shapes_with_boxes({&layer, 1}, Blend::Add, view);
    const int bands = (options.size.height + kBand - 1) / kBand;
    parallel_for(bands, [&](int b) {
      const Box band{0, b * kBand, options.size.width, std::min(options.size.height, (b + 1) * kBand)};
      for (const BandShape& item : shapes) {
        monitor.check();
        const Box box = intersection(item.box, band);
        if (box.empty()) continue;
        const Rgb c = item.shape->color;
        const float o = static_cast<float>(item.shape->opacity);
        const Rgb linear{o * linear_from_srgb(c.r), o * linear_from_srgb(c.g), o * linear_from_srgb(c.b)};
        // Where branches of one layer overlap, the brighter counts: a furcation is no hotter than its trunk.
        cover(*item.shape, view, box, [&](int x, int y, float share) {
          for (int k = 0; k < 3; ++k) own(x, y)[k] = std::max(own(x, y)[k], share * linear[k]);
        });
      }
    });
    if (layer.blur > 0.0) own = gaussian_blur(own, layer.blur * view.scale);
    for (std::size_t i = 0; i < own.pixels().size(); ++i) light.pixels()[i] = light.pixels()[i] + own.pixels()[i];
  }
  return light;
}

// Adds light to an encoded colour in linear light, with a soft shoulder instead of a hard clip.
Rgb lit(const Rgb& color, const Rgb& light) {
  Rgb out;
  for (int k = 0; k < 3; ++k) {
    const float base = std::clamp(linear_from_srgb(color[k]), 0.0f, 1.0f);
    out[k] = srgb_from_linear(base + (1.0f - base) * exposed(std::max(0.0f, light[k])));
  }
  return out;
}

// Light without a background: as much opacity as the brightest channel needs, so that on black it looks as it should.
Premultiplied glow_over_nothing(const Rgb& light) {
  const Rgb seen = lit({}, light);
  return {seen, std::max({seen.r, seen.g, seen.b})};
}

}  // namespace

Raster rasterize(const Drawing& drawing, const RasterOptions& options, const Monitor& monitor) {
  if (std::max(options.size.width, options.size.height) > kMostRasterSide) {
    throw LimitError("a side of " + std::to_string(std::max(options.size.width, options.size.height)) + " px is more than the " +
                     std::to_string(kMostRasterSide) + " px a painting can have; choose a smaller --scale or write .svg");
  }
  const View view{options.scale, options.shift};
  const ColorImage light = emitted_light(drawing, options, view, monitor);
  std::vector<BandLayer> layers;
  for (const Layer& layer : drawing.layers) {
    if (layer.blend == Blend::Over)
      layers.push_back({shapes_with_boxes({&layer, 1}, Blend::Over, view), static_cast<float>(layer.opacity), {}});
    if (layer.blend == Blend::Wash) layers.push_back({{}, 1.0f, density_of(layer, options, view, monitor)});
  }
  Raster out{ColorImage(options.size), Mask(options.size)};
  const int width = options.size.width, bands = (options.size.height + kBand - 1) / kBand;
  parallel_for(bands, [&](int b) {
    monitor.check();
    const Box band{0, b * kBand, width, std::min(options.size.height, (b + 1) * kBand)};
    Image<Premultiplied> pixels(width, band.y1 - band.y0);
    for (int y = band.y0; y < band.y1; ++y) {
      for (int x = 0; x < width; ++x) {
        if (options.over) pixels(x, y - band.y0) = {(*options.over)(x, y), 1.0f};
        else if (drawing.background) pixels(x, y - band.y0) = {*drawing.background, 1.0f};
      }
    }
    for (const BandLayer& layer : layers) paint_layer(layer, view, band, pixels);
    for (int y = band.y0; y < band.y1; ++y) {
      for (int x = 0; x < width; ++x) {
        Premultiplied p = pixels(x, y - band.y0);
        if (!light.empty()) {
          const Premultiplied glow = glow_over_nothing(light(x, y));
          if (p.alpha >= 1.0f) p.color = lit(p.color, light(x, y));
          else p = {glow.color + (1.0f - glow.alpha) * p.color, glow.alpha + (1.0f - glow.alpha) * p.alpha};
        }
        if (p.alpha <= 0.0f) continue;
        // Rounded up, and the colour divided by the rounded value: nothing is lost to 8 bits of opacity.
        const float alpha = std::min(255.0f, std::ceil(p.alpha * 255.0f - 1e-3f));
        if (alpha <= 0.0f) continue;
        out.alpha(x, y) = static_cast<std::uint8_t>(alpha);
        out.color(x, y) = (255.0f / alpha) * p.color;
      }
    }
  });
  return out;
}

}  // namespace ramify
