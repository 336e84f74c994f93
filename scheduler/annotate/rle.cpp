#include "annotate/rle.h"

namespace seedframe {
namespace {

void append_number(std::string& out, std::int64_t value) {
  bool more = true;
  while (more) {
    const std::int64_t group = value & 0x1f;
    value >>= 5;
    // The number ends when what is left is only the sign that bit 0x10 of this group already shows.
    more = (group & 0x10) != 0 ? value != -1 : value != 0;
    out += static_cast<char>(48 + group + (more ? 0x20 : 0));
  }
}

}  // namespace

Rle encode_rle(const Mask& mask) {
  Rle rle{.height = mask.image_height(), .width = mask.image_width(), .counts = {}};
  const std::int64_t height = rle.height;
  const std::int64_t pixels = height * rle.width;
  std::int64_t run_begin = 0;
  std::int64_t pending = -1;  // a change that the next one may take back
  const auto end_run = [&](std::int64_t position) {
    rle.counts.push_back(static_cast<std::uint32_t>(position - run_begin));
    run_begin = position;
  };
  // A run that ends below a column's last row and goes on at the top of the next has no end there.
  mask.for_each_change([&](int column, int row) {
    const std::int64_t position = column * height + row;
    if (pending == position) {
      pending = -1;
      return;
    }
    if (pending >= 0) end_run(pending);
    pending = position;
  });
  if (pending >= 0 && pending < pixels) end_run(pending);
  rle.counts.push_back(static_cast<std::uint32_t>(pixels - run_begin));
  return rle;
}

Rle encode_rle(std::span<const std::uint8_t> mask, int width, int height) {
  Rle rle{.height = height, .width = width, .counts = {}};
  std::uint8_t present = 0;
  std::uint32_t run = 0;
  for (int column = 0; column < width; ++column) {
    for (int row = 0; row < height; ++row) {
      const std::uint8_t value =
          mask[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(column)];
      if (value != present) {
        rle.counts.push_back(run);
        run = 0;
        present = value;
      }
      ++run;
    }
  }
  rle.counts.push_back(run);
  return rle;
}

std::int64_t rle_area(const Rle& rle) {
  std::int64_t area = 0;
  for (std::size_t i = 1; i < rle.counts.size(); i += 2) area += rle.counts[i];
  return area;
}

std::string rle_string(const Rle& rle) {
  std::string text;
  for (std::size_t i = 0; i < rle.counts.size(); ++i) {
    std::int64_t value = rle.counts[i];
    if (i > 2) value -= rle.counts[i - 2];
    append_number(text, value);
  }
  return text;
}

std::optional<Rle> rle_from_string(std::string_view text, int width, int height) {
  Rle rle{.height = height, .width = width, .counts = {}};
  const std::int64_t pixels = std::int64_t{width} * height;
  std::int64_t total = 0;
  std::size_t next = 0;
  while (next < text.size()) {
    std::int64_t value = 0;
    int shift = 0;
    bool more = true;
    while (more) {
      if (next == text.size() || shift > 35) return std::nullopt;
      const int character = text[next++] - 48;
      if (character < 0 || character > 63) return std::nullopt;
      value |= std::int64_t{character & 0x1f} << shift;
      shift += 5;
      more = (character & 0x20) != 0;
      if (!more && (character & 0x10) != 0) value -= std::int64_t{1} << shift;
    }
    if (rle.counts.size() > 2) value += rle.counts[rle.counts.size() - 2];
    total += value;
    if (value < 0 || total > pixels) return std::nullopt;
    rle.counts.push_back(static_cast<std::uint32_t>(value));
  }
  if (total != pixels) return std::nullopt;
  return rle;
}

}  // namespace seedframe
