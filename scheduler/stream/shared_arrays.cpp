#include "stream/shared_arrays.h"

#include <cerrno>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/files.h"

namespace seedframe {

SharedArrays::~SharedArrays() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

SharedArrays& SharedArrays::operator=(SharedArrays&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(bytes_, other.bytes_);
  std::swap(arrays_, other.arrays_);
  return *this;
}

Status SharedArrays::add(const std::string& name, const void* data, std::size_t bytes,
                         const char* dtype, const std::vector<int>& shape) {
  constexpr std::size_t kAlignment = 64;
  if (descriptor_ < 0) descriptor_ = ::memfd_create("seedframe", MFD_CLOEXEC);
  if (descriptor_ < 0) return system_failure("make", "shared memory", errno);
  const std::size_t offset = (bytes_ + kAlignment - 1) / kAlignment * kAlignment;
  std::size_t written = 0;
  while (written < bytes) {
    const ssize_t done = ::pwrite(descriptor_, static_cast<const char*>(data) + written,
                                  bytes - written, static_cast<off_t>(offset + written));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return system_failure("fill", "shared memory", errno);
    written += static_cast<std::size_t>(done);
  }
  arrays_[name] = {{"offset", offset}, {"dtype", dtype}, {"shape", shape}};
  bytes_ = offset + bytes;
  return {};
}

Json SharedArrays::to_json() const {
  Json json = arrays_;
  json["path"] = fmt::format("/proc/{}/fd/{}", ::getpid(), descriptor_);
  json["bytes"] = bytes_;
  return json;
}

}  // namespace seedframe
