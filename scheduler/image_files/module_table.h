// What the program and its image module, a library that is opened at first use, say to each other.
// Both are built from this header; the version tells when they were not.
#pragma once

#include <cstddef>
#include <cstdint>

namespace seedframe::image_module {

inline constexpr std::uint32_t kVersion = 3;

enum class Values : std::int32_t { kUint8, kUint16, kHalf, kFloat, kOther };

/// Of an image that has been opened. What is pointed to lives as long as the call that hands it on.
struct Header {
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::int32_t channels = 0;
  Values stored = Values::kOther;
  const char* const* channel_names = nullptr;  ///< as many as channels
  const char* color_model = "";                ///< where the file names one, as "cmyk"
  bool has_more_images = false;                ///< pages, parts or layers of the file
  bool is_deep = false;
  bool is_cropped = false;  ///< its pixels are not those of the whole picture
};

/// Called by read(): header once, then rows from top to bottom. False ends the reading.
struct ReadCalls {
  void* self = nullptr;
  bool (*header)(void* self, const Header* header) = nullptr;
  /// Interleaved; uint8 if the file has uint8, else float (integers as 0 … 1).
  bool (*rows)(void* self, std::int32_t first, std::int32_t count, const void* values) = nullptr;
};

struct WriteRequest {
  const char* writer = "";  ///< "jpeg", "webp", "tiff"
  std::int32_t width = 0;
  std::int32_t height = 0;
  const std::uint8_t* rgb = nullptr;
  const char* compression = "";  ///< as the library names it; empty: the writer's own
};

struct ByteSink {
  void* self = nullptr;
  void (*bytes)(void* self, const void* bytes, std::size_t size) = nullptr;
};

/// Interleaved, row 0 on top.
struct FloatPixels {
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::int32_t channels = 0;
  float* values = nullptr;
};

/// Why a call returned false.
struct Fault {
  char text[1024] = "";
};

struct Table {
  std::uint32_t version = kVersion;
  bool (*read)(const char* reader, const void* bytes, std::size_t size, const ReadCalls* calls,
               Fault* fault) = nullptr;
  bool (*write)(const WriteRequest* request, const ByteSink* sink, Fault* fault) = nullptr;
  /// Fills `to`; the filters are the library's, by name.
  bool (*resize)(const FloatPixels* from, const FloatPixels* to, const char* filter_across,
                 const char* filter_down, Fault* fault) = nullptr;
};

/// The one symbol of the module.
inline constexpr const char* kEntry = "seedframe_image_module";
using Entry = const Table* (*)();

}  // namespace seedframe::image_module
