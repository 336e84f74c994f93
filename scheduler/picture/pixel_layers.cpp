#include "picture/pixel_layers.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "rays/ray_scene.h"

namespace seedframe {
namespace {

using Rgb8 = std::array<std::uint8_t, 3>;

constexpr std::uint8_t kDiffersInside = 255, kDiffersAtEdge = 128, kCoincides = 64;

bool is_seen(float depth) { return std::isfinite(depth) && depth > 0.0F && depth < kNoDepth; }

Image<std::uint8_t> filled_with(const DisplayColor& color, int width, int height) {
  const Rgb8 bytes = color_bytes(color);
  Image<std::uint8_t> image(width, height, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = bytes[i % 3];
  return image;
}

/// Grey and darker, so that colours over it tell.
void dim(Image<std::uint8_t>& image) {
  for (std::size_t i = 0; i < image.values.size(); i += 3) {
    std::uint8_t* rgb = &image.values[i];
    const int grey = (54 * rgb[0] + 183 * rgb[1] + 19 * rgb[2]) / 256;
    std::fill_n(rgb, 3, static_cast<std::uint8_t>(24 + grey * 5 / 8));
  }
}

void paint_depth(const Image<float>& depth, Image<std::uint8_t>& image) {
  constexpr std::size_t kSteps = 256;
  static const std::array<Rgb8, kSteps> scale = [] {
    std::array<Rgb8, kSteps> colors{};
    for (std::size_t i = 0; i < kSteps; ++i) {
      colors[i] = color_bytes(depth_color(1.0 - static_cast<double>(i) / (kSteps - 1)));
    }
    return colors;
  }();
  const auto range = depth_range(depth);
  if (!range) return;
  const double extent = std::max((*range)[1] - (*range)[0], 1e-9);
  for (std::size_t i = 0; i < depth.values.size(); ++i) {
    if (!is_seen(depth.values[i])) continue;
    const double share = std::clamp((depth.values[i] - (*range)[0]) / extent, 0.0, 1.0);
    const Rgb8& color = scale[static_cast<std::size_t>(std::lround(share * (kSteps - 1)))];
    std::copy(color.begin(), color.end(), &image.values[3 * i]);
  }
}

/// x, y, z from -1 to 1 as red, green, blue.
void paint_normals(const Image<float>& normal, Image<std::uint8_t>& image) {
  for (std::size_t i = 0; i < normal.values.size(); i += 3) {
    const float* n = &normal.values[i];
    if (n[0] == 0.0F && n[1] == 0.0F && n[2] == 0.0F) continue;
    const Rgb8 color = color_bytes({0.5 + 0.5 * n[0], 0.5 + 0.5 * n[1], 0.5 + 0.5 * n[2]});
    std::copy(color.begin(), color.end(), &image.values[i]);
  }
}

void blend(std::uint8_t* rgb, const Rgb8& color, int opacity_percent) {
  for (std::size_t c = 0; c < 3; ++c) {
    rgb[c] = static_cast<std::uint8_t>(
        (rgb[c] * (100 - opacity_percent) + color[c] * opacity_percent + 50) / 100);
  }
}

/// Over each pixel the colour of its instance, if it has one.
void paint_masks(const Image<std::uint16_t>& ids, const std::map<int, DisplayColor>& colors,
                 int opacity_percent, Image<std::uint8_t>& image) {
  std::vector<std::optional<Rgb8>> by_id;
  for (const auto& [id, color] : colors) {
    if (by_id.size() <= static_cast<std::size_t>(id))
      by_id.resize(static_cast<std::size_t>(id) + 1);
    by_id[static_cast<std::size_t>(id)] = color_bytes(color);
  }
  for (std::size_t i = 0; i < ids.values.size(); ++i) {
    const std::uint16_t id = ids.values[i];
    if (id < by_id.size() && by_id[id]) blend(&image.values[3 * i], *by_id[id], opacity_percent);
  }
}

std::map<int, DisplayColor> semantic_colors(const FrameLabels& labels) {
  std::map<int, DisplayColor> colors;
  for (const InstanceLabel& label : labels.instances) {
    if (label.category > 0) colors[label.id] = class_color(label.category);
  }
  return colors;
}

void paint_disagreement(const Image<std::uint8_t>& kinds, Image<std::uint8_t>& image) {
  for (std::size_t i = 0; i < kinds.values.size(); ++i) {
    if (kinds.values[i] == 0) continue;
    const Rgb8 color = color_bytes(disagreement_color(kinds.values[i]));
    std::copy(color.begin(), color.end(), &image.values[3 * i]);
  }
}

}  // namespace

DisplayColor disagreement_color(std::uint8_t kind) {
  if (kind == kDiffersInside) return kInsideColor;
  return kind == kDiffersAtEdge ? kEdgeColor : kCoincidentColor;
}

std::map<int, DisplayColor> instance_colors(const FrameLabels& labels) {
  std::map<int, DisplayColor> colors;
  std::map<int, std::size_t> met;  // by category
  for (const InstanceLabel& label : labels.instances) {
    if (label.area_px == 0) continue;
    colors[label.id] = instance_color(label.category, met[label.category]++);
  }
  return colors;
}

std::optional<std::array<double, 2>> depth_range(const Image<float>& depth) {
  std::vector<float> seen;
  std::copy_if(depth.values.begin(), depth.values.end(), std::back_inserter(seen), is_seen);
  if (seen.empty()) return std::nullopt;
  const auto at = [&](std::size_t position) {
    std::nth_element(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(position),
                     seen.end());
    return static_cast<double>(seen[position]);
  };
  const std::size_t hundredth = seen.size() / 100;
  const double nearest = at(hundredth);
  return std::array{nearest, at(seen.size() - 1 - hundredth)};
}

DisagreementCount count_disagreement(const Image<std::uint8_t>& disagreement) {
  const auto count = [&](std::uint8_t kind) {
    return std::count(disagreement.values.begin(), disagreement.values.end(), kind);
  };
  return {count(kDiffersInside), count(kDiffersAtEdge), count(kCoincides)};
}

Image<std::uint8_t> pixels_of(const FrameContent& content, const LayerSet& layers) {
  const bool has_image = layers.has(Layer::kImage);
  const bool has_masks = layers.has(Layer::kSemantic) || layers.has(Layer::kInstances);
  Image<std::uint8_t> pixels =
      has_image ? *content.image
                : filled_with(kBackdrop, content.instance_ids.width, content.instance_ids.height);
  if (layers.has(Layer::kDepth)) paint_depth(*content.depth, pixels);
  if (layers.has(Layer::kNormals)) paint_normals(*content.normal, pixels);
  if (has_image && (has_masks || layers.has(Layer::kDisagreement))) dim(pixels);
  const bool is_bare = !has_image && !layers.has(Layer::kDepth) && !layers.has(Layer::kNormals);
  const int opacity_percent = is_bare ? 100 : 65;
  if (layers.has(Layer::kSemantic)) {
    paint_masks(content.instance_ids, semantic_colors(content.labels), opacity_percent, pixels);
  }
  if (layers.has(Layer::kInstances)) {
    paint_masks(content.instance_ids, instance_colors(content.labels), opacity_percent, pixels);
  }
  if (layers.has(Layer::kDisagreement)) {
    if (is_bare && !has_masks) {
      paint_masks(content.instance_ids, instance_colors(content.labels), 100, pixels);
      dim(pixels);
    }
    paint_disagreement(*content.disagreement, pixels);
  }
  return pixels;
}

}  // namespace seedframe
