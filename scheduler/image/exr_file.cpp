#include "image/exr_file.h"

#include <cassert>
#include <exception>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>

#include "base/files.h"
#include "image/exr_blocks.h"
#include "image/exr_input.h"
#include "image/exr_memory.h"

namespace seedframe {
namespace {

// Twice as fast as OpenEXR's default of 4, for files 4 % larger.
constexpr int kZipLevel = 2;

Imf::FrameBuffer frame_buffer(const Image<float>& image, const std::vector<std::string>& channels) {
  const std::size_t x_stride = sizeof(float) * channels.size();
  const std::size_t y_stride = x_stride * static_cast<std::size_t>(image.width);
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    // OpenEXR's slices are not const; writing a file only reads through them.
    auto* first = reinterpret_cast<char*>(const_cast<float*>(image.values.data() + c));
    buffer.insert(channels[c], Imf::Slice(Imf::FLOAT, first, x_stride, y_stride));
  }
  return buffer;
}

}  // namespace

Status write_exr(const std::filesystem::path& path, const Image<float>& image,
                 const std::vector<std::string>& channels) {
  assert(static_cast<std::size_t>(image.channels) == channels.size());
  ExrMemoryOutput output;
  try {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.zipCompressionLevel() = kZipLevel;
    for (const std::string& channel : channels) {
      header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    }
    Imf::OutputFile file(output, header, 0);
    file.setFrameBuffer(frame_buffer(image, channels));
    file.writePixels(image.height);
  } catch (const std::exception& exception) {
    return fail(ErrorKind::kExhausted, "cannot write {} ({} x {} pixels): {}", path.string(),
                image.width, image.height, exception.what());
  }
  return write_file_unsynced(path, output.bytes());
}

Result<Image<float>> read_exr_channel(const std::filesystem::path& path,
                                      const std::string& channel) {
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return fail(ErrorKind::kCorrupt, "{}", bytes.error().message);
  const auto damaged = [&](const char* fault) {
    return fail(ErrorKind::kCorrupt, "cannot read {}: {}", path.string(), fault);
  };
  if (const char* fault = exr_header_fault(*bytes)) return damaged(fault);
  try {
    ExrMemoryInput stream(*bytes, path.string());
    Imf::MultiPartInputFile file(stream, /*numThreads=*/0, /*reconstructChunkOffsetTable=*/false);
    const Imf::Header& header = file.header(0);
    if (const char* fault = exr_size_fault(header, bytes->size())) return damaged(fault);
    const Imath::Box2i& window = header.dataWindow();
    const Imf::Channel* found = header.channels().findChannel(channel);
    if (found == nullptr || found->type != Imf::FLOAT || window.min != Imath::V2i(0, 0)) {
      return fail(ErrorKind::kCorrupt, "{} is not an image with a float channel '{}'",
                  path.string(), channel);
    }
    Image<float> image(window.max.x + 1, window.max.y + 1);
    if (const char* fault = read_exr_blocks(*bytes, header, frame_buffer(image, {channel}))) {
      return damaged(fault);
    }
    return image;
  } catch (const std::exception& exception) {
    return damaged(exception.what());
  }
}

}  // namespace seedframe
