#include "frames/frame_fingerprint.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/sha256.h"

namespace seedframe {

namespace {

struct FileStamp {
  std::string name;
  std::array<std::int64_t, 4> numbers{};  ///< mode, size, seconds and nanoseconds of its time
};

}  // namespace

std::string frame_fingerprint(const std::filesystem::path& folder) {
  const int descriptor =
      ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return {};
  const std::unique_ptr<DIR, int (*)(DIR*)> listing(::fdopendir(descriptor), ::closedir);
  if (!listing) {
    ::close(descriptor);
    return {};
  }
  constexpr std::size_t kFilesOfAFrame = 10;
  std::vector<FileStamp> files;
  files.reserve(kFilesOfAFrame);
  while (const dirent* entry = ::readdir(listing.get())) {
    const std::string_view name = entry->d_name;
    if (name == "." || name == "..") continue;
    struct stat info = {};
    if (::fstatat(::dirfd(listing.get()), entry->d_name, &info, AT_SYMLINK_NOFOLLOW) != 0)
      return {};
    files.push_back({std::string(name),
                     {info.st_mode, info.st_size, info.st_mtim.tv_sec, info.st_mtim.tv_nsec}});
  }
  std::sort(files.begin(), files.end(),
            [](const FileStamp& a, const FileStamp& b) { return a.name < b.name; });
  std::string text;
  for (const FileStamp& file : files) {
    text += file.name;
    text += '\0';
    text.append(reinterpret_cast<const char*>(file.numbers.data()), sizeof file.numbers);
  }
  return sha256_hex(text);
}

}  // namespace seedframe
