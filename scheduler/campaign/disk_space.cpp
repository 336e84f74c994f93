#include "campaign/disk_space.h"

#include <array>
#include <cerrno>
#include <cmath>

#include <sys/statvfs.h>

#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;

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

Result<std::uint64_t> expected_frame_bytes(const Campaign& campaign,
                                           const CampaignSettings& settings) {
  constexpr int kSample = 16;
  const auto rows = campaign.store.frames_in(FrameState::kDone, kSample);
  if (!rows) return forward_error(rows);
  std::uint64_t sum = 0;
  std::uint64_t frames = 0;
  for (const FrameRow& row : *rows) {
    const Result<Manifest> manifest = read_manifest(campaign.files.frame(row.frame));
    if (!manifest) continue;
    for (const auto& [name, file] : manifest->files) sum += file.bytes;
    ++frames;
  }
  return frames == 0 ? typical_frame_bytes(settings) : sum / frames;
}

std::uint64_t room_for_attempts(const RunSetup& setup) {
  // One is rendered, some wait to be finished; each takes its bytes twice for a while.
  constexpr std::uint64_t kFrames = 4;
  return setup.frame_bytes * kFrames * static_cast<std::uint64_t>(setup.options.pool.workers);
}

Result<std::uint64_t> free_bytes(const fs::path& folder) {
  struct statvfs info = {};
  if (::statvfs(folder.c_str(), &info) != 0) return system_failure("look at", folder, errno);
  return std::uint64_t{info.f_bavail} * info.f_frsize;
}

Status check_disk(const CampaignFiles& files, std::uint64_t needed) {
  const Result<std::uint64_t> free = free_bytes(files.root());
  if (!free) return forward_error(free);
  if (*free < needed) {
    return fail(ErrorKind::kExhausted,
                "the disk of {} is full: {} are free, {} are needed to go on",
                files.root().string(), bytes_text(*free), bytes_text(needed));
  }
  constexpr std::size_t kProbeBytes = 4096;
  if (Status made = make_folders(files.work()); !made) return made;
  const Status written = write_file(files.disk_probe(), std::string(kProbeBytes, '\0'));
  std::error_code ignored;
  fs::remove(files.disk_probe(), ignored);
  if (written) return {};
  return tl::unexpected(Error{ErrorKind::kExhausted, written.error().message});
}

std::string bytes_text(std::uint64_t bytes) {
  constexpr std::array<const char*, 5> kUnits = {"B", "kB", "MB", "GB", "TB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  while (value >= 1000.0 && unit + 1 < kUnits.size()) {
    value /= 1000.0;
    ++unit;
  }
  return unit == 0 ? fmt::format("{} B", bytes) : fmt::format("{:.1f} {}", value, kUnits[unit]);
}

}  // namespace seedframe
