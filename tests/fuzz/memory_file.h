// A file for code that wants a path, without a disk.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include <unistd.h>

#include "base/files.h"
#include "tests/fuzz/promise.h"

namespace seedframe {

class MemoryFile {
 public:
  MemoryFile() {
    const bool memory = ::access("/dev/shm", W_OK) == 0;
    path_ = (memory ? std::filesystem::path("/dev/shm") : std::filesystem::temp_directory_path()) /
            "fuzz-XXXXXX";
    std::string name = path_.string();
    const int descriptor = ::mkstemp(name.data());
    promise(descriptor >= 0, "there is a folder for scratch");
    ::close(descriptor);
    path_ = name;
  }
  ~MemoryFile() { ::unlink(path_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void write(std::string_view bytes) const {
    promise(write_file_unsynced(path(), bytes).has_value(), "a file in memory can be written");
  }
  std::string bytes() const { return read_file(path()).value_or(""); }

 private:
  std::filesystem::path path_;
};

}  // namespace seedframe
