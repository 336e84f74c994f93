// EXR files from anywhere as bytes in memory: what OpenEXR must not be given unchecked.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>

namespace seedframe {

/// Throws on every step outside the bytes, as OpenEXR asks of a stream.
class ExrMemoryInput : public Imf::IStream {
 public:
  /// `bytes` must outlive this.
  ExrMemoryInput(std::string_view bytes, const std::string& name)
      : Imf::IStream(name.c_str()), bytes_(bytes) {}

  bool read(char to[], int count) override;
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::string_view bytes_;
  std::uint64_t position_ = 0;
};

/// `at` and what follows must be inside the bytes.
template <class T>
T little_endian(std::string_view bytes, std::size_t at) {
  T value = 0;
  for (std::size_t i = sizeof(T); i-- > 0;) {
    value = static_cast<T>(value << 8 | static_cast<unsigned char>(bytes[at + i]));
  }
  return value;
}

/// OpenEXR trusts the stated length of an attribute and allocates that before it reads it, up to
/// 2 GB. So walk the header first: every length must lie inside the file and be that of its type,
/// and the file must be one part of scan lines. Returns what is wrong, or null.
const char* exr_header_fault(std::string_view bytes);

/// Where the table of a file's blocks begins; for a header without a fault.
std::size_t exr_header_end(std::string_view bytes);

/// OpenEXR allocates memory for as many pixels as the header claims. Returns what is wrong with
/// more than a lossless compression can hold in `file_bytes`, or null.
const char* exr_size_fault(const Imf::Header& header, std::size_t file_bytes);

}  // namespace seedframe
