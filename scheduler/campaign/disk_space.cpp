#include "campaign/disk_space.h"

#include <array>
#include <cerrno>

#include <sys/statvfs.h>

#include "base/files.h"
#include "plan/frame_bytes.h"

namespace seedframe {
namespace fs = std::filesystem;

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
