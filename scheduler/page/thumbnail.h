// A frame made small: its picture, which object is where in it, and a few numbers to know it by.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "image/image.h"

namespace seedframe {

struct ThumbnailSize {
  int width = 0;
  int height = 0;

  bool operator==(const ThumbnailSize&) const = default;
};

/// As large as so many pictures of width × height may be, so that a page with all of them stays
/// below 50 MB; never larger than the picture.
ThumbnailSize thumbnail_size(int width, int height, std::int64_t frames);

/// RGB in sRGB; each pixel the mean of the area that it covers, in linear light.
Image<std::uint8_t> reduced(const Image<std::uint8_t>& image, ThumbnailSize size);

/// For each pixel the object whose id is at its centre: 1 + its place in `ids`; 0 where it is none
/// of these. From the 255th object on they are all 255.
Image<std::uint8_t> reduced_mask(const Image<std::uint16_t>& instance_ids,
                                 const std::vector<int>& ids, ThumbnailSize size);

/// Means over 8 × 8 parts of a picture, each of R, G, B: what pictures are compared by.
using PictureSignature = std::array<std::uint8_t, 192>;
PictureSignature signature_of(const Image<std::uint8_t>& image);

/// Mean luma (Rec. 709 weights, of code values), 0 to 255.
double mean_luma(const PictureSignature& signature);

}  // namespace seedframe
