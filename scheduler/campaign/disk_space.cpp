#include "campaign/disk_space.h"

#include <array>
#include <cerrno>
#include <limits>

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

namespace {

Result<DiskRoom> free_room(const fs::path& folder) {
  struct statvfs info = {};
  if (::statvfs(folder.c_str(), &info) != 0) return system_failure("look at", folder, errno);
  // File systems without a table of inodes say that it has none.
  const bool limited = info.f_files > 0;
  return DiskRoom{
      std::uint64_t{info.f_bavail} * info.f_frsize,
      limited ? std::uint64_t{info.f_favail} : std::numeric_limits<std::uint64_t>::max()};
}

}  // namespace

DiskRoom room_for_attempts(const RunSetup& setup) {
  // One is rendered, some wait to be finished; each takes its bytes twice for a while.
  constexpr std::uint64_t kFrames = 4;
  constexpr std::uint64_t kFilesOfAFrame = 12;  // and folders, also a bucket's
  const std::uint64_t frames = kFrames * static_cast<std::uint64_t>(setup.options.pool.workers);
  return {setup.frame_bytes * frames, kFilesOfAFrame * frames};
}

Result<std::uint64_t> free_bytes(const fs::path& folder) {
  const Result<DiskRoom> room = free_room(folder);
  if (!room) return forward_error(room);
  return room->bytes;
}

Status check_room(const fs::path& folder, const DiskRoom& needed) {
  const Result<DiskRoom> free = free_room(folder);
  if (!free) return forward_error(free);
  if (free->bytes < needed.bytes) {
    return fail(ErrorKind::kExhausted,
                "the disk of {} is full: {} are free, {} are needed to go on", folder.string(),
                bytes_text(free->bytes), bytes_text(needed.bytes));
  }
  if (free->files < needed.files) {
    return fail(ErrorKind::kExhausted,
                "the disk of {} takes no more files: {} can still be made ('df -i' shows it), {} "
                "are needed to go on",
                folder.string(), free->files, needed.files);
  }
  return {};
}

Status check_disk(const CampaignFiles& files, const DiskRoom& needed) {
  if (Status room = check_room(files.root(), needed); !room) return room;
  constexpr std::size_t kProbeBytes = 4096;
  if (Status made = make_folders_in(files.root(), files.work()); !made) return made;
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
