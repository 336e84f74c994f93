#include "page/sprite_sheet.h"

#include <algorithm>
#include <cassert>

#include "image_files/image_writer.h"
#include "page/packed.h"

namespace seedframe {
namespace {

constexpr int kSheetSide = 1536;  // pixels: a browser decodes one in some milliseconds
constexpr ImageEncoding kSheetEncoding = {.format = ImageFormat::kWebp, .quality = 72};

}  // namespace

SheetLayout sheet_layout(ThumbnailSize cell) {
  return {cell, std::max(1, kSheetSide / cell.width), std::max(1, kSheetSide / cell.height)};
}

SpriteSheet::SpriteSheet(const SheetLayout& layout, int cells, bool has_pictures)
    : layout_(layout) {
  const ThumbnailSize cell = layout.cell;
  const int columns = std::min(cells, layout.columns);
  const int rows = (cells + layout.columns - 1) / layout.columns;
  if (has_pictures) pictures_.emplace(columns * cell.width, rows * cell.height, 3);
  masks_.resize(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cell.width) *
                static_cast<std::size_t>(cell.height));
}

void SpriteSheet::set(int cell, const std::optional<Image<std::uint8_t>>& picture,
                      const Image<std::uint8_t>& mask) {
  const auto [width, height] = layout_.cell;
  assert(mask.width == width && mask.height == height);
  const auto row_bytes = static_cast<std::size_t>(width);
  std::size_t at = static_cast<std::size_t>(cell) * row_bytes * static_cast<std::size_t>(height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto above = y > 0 ? mask.at(y - 1, x) : std::uint8_t{0};
      masks_[at++] = static_cast<char>(mask.at(y, x) ^ above);
    }
  }
  if (!pictures_ || !picture) return;
  assert(picture->width == width && picture->height == height && picture->channels == 3);
  const int top = cell / layout_.columns * height;
  const int left = cell % layout_.columns * width;
  for (int y = 0; y < height; ++y) {
    std::copy_n(&picture->at(y, 0), 3 * row_bytes, &pictures_->at(top + y, left));
  }
}

Result<Json> SpriteSheet::encode() const {
  Json sprite;
  if (pictures_) {
    const Result<std::string> webp = encode_image(*pictures_, kSheetEncoding);
    if (!webp) return forward_error(webp);
    sprite = base64(*webp);
  }
  return Json{{"sprite", sprite}, {"masks", packed(masks_)}};
}

}  // namespace seedframe
