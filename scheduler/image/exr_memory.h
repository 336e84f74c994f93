// EXR files as bytes in memory, for writing them out with errors noticed.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

#include <OpenEXR/ImfIO.h>

namespace seedframe {

/// An EXR put together in memory: OpenEXR writes its last table in a destructor that swallows
/// errors, so on a full disk it would leave a cut file and report success.
class ExrMemoryOutput : public Imf::OStream {
 public:
  ExrMemoryOutput() : Imf::OStream("memory") {}

  void write(const char bytes[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (bytes_.size() < position_ + size) bytes_.resize(position_ + size);
    std::memcpy(bytes_.data() + position_, bytes, size);
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

}  // namespace seedframe
