#include "picture/frame_picture.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "picture/canvas.h"
#include "picture/pixel_layers.h"
#include "picture/pixel_scaling.h"

namespace seedframe {
namespace {

constexpr DisplayColor kMessageGround = {0.955, 0.94, 0.92};
constexpr DisplayColor kMessageInk = {0.62, 0.20, 0.05};
constexpr DisplayColor kMessageText = {0.30, 0.28, 0.26};

std::string counted_pixels(std::int64_t count, const char* where) {
  return fmt::format("{} px {}", count, where);
}

std::string note_of(const DisagreementCount& count) {
  if (count.inside_px + count.edge_px + count.coincident_px == 0) return "no pixel differs";
  std::string note =
      counted_pixels(count.inside_px, "inside") + ", " + counted_pixels(count.edge_px, "at edges");
  if (count.coincident_px > 0) note += ", " + counted_pixels(count.coincident_px, "coincide");
  return note;
}

void add(std::string& note, const std::string& more) { note += (note.empty() ? "" : " · ") + more; }

/// A ring around each pixel that differs, which alone would hardly be seen; of so many that they
/// would cover all, none.
void mark_disagreement(const Image<std::uint8_t>& kinds, double scale, Canvas& canvas) {
  constexpr std::int64_t kMost = 400;
  const DisagreementCount count = count_disagreement(kinds);
  if (count.inside_px + count.edge_px + count.coincident_px > kMost) return;
  const double radius = std::max(4.0, scale);
  for (int row = 0; row < kinds.height; ++row) {
    for (int column = 0; column < kinds.width; ++column) {
      if (kinds.at(row, column) == 0) continue;
      canvas.disc({scale * (column + 0.5), scale * (row + 0.5)}, radius,
                  {.color = disagreement_color(kinds.at(row, column)), .width = 1.5});
    }
  }
}

}  // namespace

TileSize tile_size(int frame_width, int frame_height, int most_width, int least_width) {
  if (frame_width > most_width) {
    const double scale = static_cast<double>(most_width) / frame_width;
    return {most_width, std::max(1, static_cast<int>(std::lround(frame_height * scale))), scale};
  }
  const int fits = most_width / frame_width;
  const int wanted = (least_width + frame_width - 1) / frame_width;
  const int factor = std::max(1, std::min(fits, wanted));
  return {factor * frame_width, factor * frame_height, static_cast<double>(factor)};
}

FramePicture draw_frame(const FrameContent& content, const LayerSet& layers, const TileSize& size,
                        const Skeletons& skeletons) {
  LayerSet shown;
  FramePicture picture;
  std::string first_absent, why;
  for (std::size_t i = 0; i < kLayerCount; ++i) {
    const Layer layer = static_cast<Layer>(i);
    if (!layers.has(layer)) continue;
    const auto absent = content.absent.find(layer);
    if (absent == content.absent.end()) {
      shown.add(layer);
      continue;
    }
    const std::string what = layer == Layer::kDisagreement ? std::string("not compared")
                                                           : fmt::format("no {}", kLayerNames[i]);
    add(picture.note, what);
    if (first_absent.empty()) {
      first_absent = what;
      why = absent->second;
    }
  }
  if (shown == LayerSet{}) return {draw_message(first_absent, why, size), {}};
  const Image<std::uint8_t> pixels = pixels_of(content, shown);
  Canvas canvas(size.width, size.height, kBackdrop);
  canvas.put(size.scale < 1.0 ? shrunk(pixels, size.width, size.height)
                              : enlarged(pixels, static_cast<int>(size.scale)),
             0, 0);
  if (shown.has(Layer::kDisagreement)) {
    mark_disagreement(*content.disagreement, size.scale, canvas);
    add(picture.note, note_of(count_disagreement(*content.disagreement)));
  }
  draw_overlays(content, shown, size.scale, skeletons, canvas);
  if (shown.has(Layer::kDepth)) {
    const auto range = depth_range(*content.depth);
    add(picture.note, range ? fmt::format("{:.3g} to {:.3g} m", (*range)[0], (*range)[1])
                            : std::string("nothing is seen"));
  }
  picture.pixels = canvas.image();
  return picture;
}

Image<std::uint8_t> draw_message(const std::string& title, const std::string& text,
                                 const TileSize& size) {
  Canvas canvas(size.width, size.height, kMessageGround);
  canvas.outline({0.0, 0.0, static_cast<double>(size.width), static_cast<double>(size.height)},
                 {.color = kMessageInk, .width = 1.0, .opacity = 0.4});
  const TextStyle bold{.size = 13.0, .color = kMessageInk, .bold = true};
  const TextStyle plain{.size = 11.0, .color = kMessageText};
  const double room = size.width - 20.0;
  if (room < 40.0 || size.height < 30) {  // for words there is no room
    canvas.line({0.0, 0.0}, {double(size.width), double(size.height)}, {.color = kMessageInk});
    return canvas.image();
  }
  canvas.text(canvas.fitted(title, room, bold), {10.0, 22.0}, bold);
  const int most_lines = std::max(0, (size.height - 34) / 15);
  double y = 41.0;
  for (const std::string& line : most_lines == 0 ? std::vector<std::string>{}
                                                 : canvas.wrapped(text, room, most_lines, plain)) {
    canvas.text(line, {10.0, y}, plain);
    y += 15.0;
  }
  return canvas.image();
}

}  // namespace seedframe
