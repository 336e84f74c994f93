// The lossless compressions of EXR files, undone.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include <OpenEXR/ImfCompression.h>

struct libdeflate_decompressor;

namespace seedframe {

/// Unpacks blocks, one after the other, into memory that it keeps. What OpenEXR itself does not
/// notice is an error here: it takes what a block lacks from uninitialised memory.
class ExrUnpacker {
 public:
  explicit ExrUnpacker(Imf::Compression compression);
  ~ExrUnpacker();
  ExrUnpacker(const ExrUnpacker&) = delete;
  ExrUnpacker& operator=(const ExrUnpacker&) = delete;

  /// `expected` bytes, which are there until the next call; null when the block holds fewer or
  /// more, is damaged, or is of a compression other than ZIP and run lengths.
  const char* unpack(std::string_view packed, std::size_t expected);

 private:
  bool inflate(std::string_view packed);

  Imf::Compression compression_;
  libdeflate_decompressor* inflater_;
  std::vector<char> halves_;  ///< as packed: every second byte, then the others
  std::vector<char> bytes_;
};

}  // namespace seedframe
