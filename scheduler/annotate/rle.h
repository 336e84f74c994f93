// COCO's run-length encoding of a mask (the format of pycocotools).
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "annotate/mask.h"

namespace seedframe {

/// Runs of alternating background and mask, background first (0 long when the first pixel is in the
/// mask), over the whole image column by column. They add up to width · height.
struct Rle {
  int height = 0;
  int width = 0;
  std::vector<std::uint32_t> counts;
};

Rle encode_rle(const Mask& mask);

/// Of a mask that is an array of 0 and 1, row by row.
Rle encode_rle(std::span<const std::uint8_t> mask, int width, int height);

/// Number of mask pixels: the sum of every second run.
std::int64_t rle_area(const Rle& rle);

/// Calls visit(column, first row, end row) for every stretch of mask pixels in a column.
template <class Visit>
void for_each_stretch(const Rle& rle, Visit visit) {
  const std::int64_t height = rle.height;
  std::int64_t position = 0;
  for (std::size_t i = 0; i < rle.counts.size(); ++i) {
    const std::int64_t end = position + rle.counts[i];
    while (i % 2 == 1 && position < end) {
      const std::int64_t column = position / height;
      const std::int64_t stretch_end = std::min(end, (column + 1) * height);
      visit(static_cast<int>(column), static_cast<int>(position - column * height),
            static_cast<int>(stretch_end - column * height));
      position = stretch_end;
    }
    position = end;
  }
}

/// The runs as printable ASCII. From the fourth run on the difference to the run two before is
/// written; each number in groups of five bits, lowest first, two's complement; a character is
/// 48 + the five bits + 32 if another group follows. Equal to the string that pycocotools writes.
std::string rle_string(const Rle& rle);

/// Reads what rle_string wrote; none if it is not that, or does not add up to width · height.
std::optional<Rle> rle_from_string(std::string_view text, int width, int height);

}  // namespace seedframe
