#include "plan/frame_bytes.h"

#include <cmath>

namespace seedframe {
namespace {

/// Of a file with the picture; as measured on configs/parts.yaml, at the qualities that are the
/// default.
double bytes_per_pixel(const ImageEncoding& picture) {
  switch (picture.format) {
    case ImageFormat::kJpeg:
      return 0.5;
    case ImageFormat::kWebp:
      return 0.4;
    case ImageFormat::kTiff:
      return picture.tiff == TiffCompression::kNone ? 3.0 : 2.2;
    case ImageFormat::kPng:
      break;
  }
  return 2.0;
}

}  // namespace

std::uint64_t typical_frame_bytes(const CampaignSettings& settings) {
  const RenderSettings& render = settings.render;
  const bool rendered = settings.labels == LabelSource::kIndexPass;
  const double depth = render.depth ? 1.0 : 0.0;
  const double normal = render.normal ? 1.0 : 0.0;
  double pixel_bytes = 3.0 * depth + (rendered ? 12.0 : 2.0) * normal;
  // The picture, and passes.exr: half RGBA, float index, depth and normal, deflated to two thirds.
  if (rendered) {
    pixel_bytes +=
        bytes_per_pixel(settings.image_encoding) + 0.67 * (12.0 + 4.0 * depth + 12.0 * normal);
  }
  constexpr double kOtherFiles = 64e3;
  return static_cast<std::uint64_t>(
      std::ceil(pixel_bytes * render.width * render.height + kOtherFiles));
}

}  // namespace seedframe
