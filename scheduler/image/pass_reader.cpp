#include "image/pass_reader.h"

#include <cassert>
#include <cmath>
#include <exception>
#include <string_view>
#include <vector>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>

#include "base/files.h"
#include "image/exr_blocks.h"
#include "image/exr_input.h"
#include "image/pixel_hash.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// A frame has about ten channels; a header with many more would ask for memory in vain.
constexpr int kMostChannels = 64;

/// What a pass is called in a multilayer EXR, <view layer>.<layer>.<component>.
struct PassNames {
  const char* pass;
  std::string_view layer;        ///< the name that Blender 3 gives it
  std::string_view later_layer;  ///< the name that a later Blender may give it
  std::string_view components;   ///< a letter each
};

constexpr PassNames kCombined{"combined", "Combined", "Combined", "RGBA"};
constexpr PassNames kIndex{"index", "IndexOB", "Object Index", "X"};
constexpr PassNames kDepth{"depth", "Depth", "Depth", "Z"};
constexpr PassNames kNormal{"normal", "Normal", "Normal", "XYZ"};
constexpr PassNames kSamples{"sample count", "Debug Sample Count", "Debug Sample Count", "X"};

struct Pass {
  const PassNames* names = nullptr;
  std::vector<std::string> channels;  ///< full names in the file, in the order of the components
  bool half = false;
  Image<float> pixels;

  std::string component_list() const {
    return fmt::format("{}", fmt::join(names->components, ","));
  }
};

template <class... Args>
tl::unexpected<Error> unusable(const fs::path& path, fmt::format_string<Args...> format,
                               Args&&... args) {
  return fail(ErrorKind::kRender, "{}: {}", path.string(),
              fmt::format(format, std::forward<Args>(args)...));
}

Status check_header(const fs::path& path, const Imf::Header& header,
                    const PassExpectation& expected) {
  const Imath::Box2i& window = header.dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width != expected.width || height != expected.height) {
    return unusable(path, "expected {} x {} pixels, found {} x {}", expected.width, expected.height,
                    width, height);
  }
  if (window.min != Imath::V2i(0, 0)) {
    return unusable(path, "expected pixels from (0, 0), found them from ({}, {})", window.min.x,
                    window.min.y);
  }
  if (!expected.frame_id.empty()) {
    const auto* note = header.findTypedAttribute<Imf::StringAttribute>("Note");
    if (note == nullptr || note->value() != expected.frame_id) {
      return unusable(path, "expected the passes of frame {}, found those of {}",
                      expected.frame_id.substr(0, 12),
                      note == nullptr ? "no frame" : note->value().substr(0, 12));
    }
  }
  if (header.hasTileDescription()) return unusable(path, "expected scan lines, found tiles");
  switch (header.compression()) {
    case Imf::NO_COMPRESSION:
    case Imf::RLE_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
    case Imf::ZIP_COMPRESSION:
      break;
    default:
      return unusable(path, "expected a lossless compression (ZIP), found OpenEXR's number {}",
                      static_cast<int>(header.compression()));
  }
  int channels = 0;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) ++channels;
  if (channels > kMostChannels) {
    return unusable(path, "expected at most {} channels, found {}", kMostChannels, channels);
  }
  return {};
}

bool ends_in(std::string_view channel, std::string_view layer, char component) {
  const std::string suffix = fmt::format("{}.{}", layer, component);
  if (!channel.ends_with(suffix)) return false;
  return channel.size() == suffix.size() || channel[channel.size() - suffix.size() - 1] == '.';
}

std::string channel_list(const Imf::ChannelList& channels) {
  std::vector<std::string> names;
  for (auto i = channels.begin(); i != channels.end(); ++i) names.emplace_back(i.name());
  return fmt::format("{}", fmt::join(names, ", "));
}

Result<Pass> find_pass(const fs::path& path, const Imf::ChannelList& channels,
                       const PassNames& names) {
  Pass pass;
  pass.names = &names;
  pass.half = true;
  for (const char component : names.components) {
    std::string found;
    for (auto i = channels.begin(); i != channels.end(); ++i) {
      if (!ends_in(i.name(), names.layer, component) &&
          !ends_in(i.name(), names.later_layer, component)) {
        continue;
      }
      if (!found.empty()) {
        return unusable(path, "two channels could be the {} pass: {} and {}", names.pass, found,
                        i.name());
      }
      found = i.name();
      if (i.channel().xSampling != 1 || i.channel().ySampling != 1) {
        return unusable(path, "channel {} does not have a value for every pixel", found);
      }
      pass.half = pass.half && i.channel().type == Imf::HALF;
    }
    if (found.empty()) {
      return unusable(path, "the {} pass is missing: no channel <view layer>.{}.{} among {}",
                      names.pass, names.layer, component, channel_list(channels));
    }
    pass.channels.push_back(found);
  }
  return pass;
}

Result<std::vector<Pass>> find_passes(const fs::path& path, const Imf::ChannelList& channels,
                                      const PassExpectation& expected) {
  std::vector<const PassNames*> wanted = {&kCombined, &kIndex};
  if (expected.depth) wanted.push_back(&kDepth);
  if (expected.normal) wanted.push_back(&kNormal);
  if (expected.sample_counts) wanted.push_back(&kSamples);
  std::vector<Pass> passes;
  for (const PassNames* names : wanted) {
    Result<Pass> pass = find_pass(path, channels, *names);
    if (!pass) return forward_error(pass);
    pass->pixels =
        Image<float>(expected.width, expected.height, static_cast<int>(names->components.size()));
    passes.push_back(std::move(*pass));
  }
  return passes;
}

Imf::FrameBuffer frame_buffer_of(std::vector<Pass>& passes) {
  Imf::FrameBuffer buffer;
  for (Pass& pass : passes) {
    const std::size_t x_stride = sizeof(float) * pass.channels.size();
    const std::size_t y_stride = x_stride * static_cast<std::size_t>(pass.pixels.width);
    for (std::size_t c = 0; c < pass.channels.size(); ++c) {
      char* first = reinterpret_cast<char*>(pass.pixels.values.data() + c);
      buffer.insert(pass.channels[c], Imf::Slice(Imf::FLOAT, first, x_stride, y_stride));
    }
  }
  return buffer;
}

Result<std::vector<Pass>> read_file_passes(const fs::path& path, const std::string& bytes,
                                           const PassExpectation& expected) {
  // Frames are read side by side; a pool of OpenEXR's own would only take cores from Blender.
  [[maybe_unused]] static const bool no_pool = (Imf::setGlobalThreadCount(0), true);
  try {
    ExrMemoryInput stream(bytes, path.string());
    Imf::MultiPartInputFile file(stream, 0, false);
    if (Status header = check_header(path, file.header(0), expected); !header) {
      return forward_error(header);
    }
    if (!file.partComplete(0)) return unusable(path, "the file was not written to its end");
    Result<std::vector<Pass>> passes = find_passes(path, file.header(0).channels(), expected);
    if (!passes) return passes;
    if (const char* fault = read_exr_blocks(bytes, file.header(0), frame_buffer_of(*passes))) {
      return unusable(path, "cut or damaged: {}", fault);
    }
    return passes;
  } catch (const std::exception& exception) {
    return unusable(path, "cut or damaged: {}", exception.what());
  }
}

struct PixelPosition {
  std::size_t column;
  std::size_t row;
  std::size_t channel;
};

PixelPosition position_of(const Image<float>& image, std::size_t value) {
  const auto channels = static_cast<std::size_t>(image.channels);
  const std::size_t pixel = value / channels;
  const auto width = static_cast<std::size_t>(image.width);
  return {pixel % width, pixel / width, value % channels};
}

Status check_finite(const fs::path& path, const Pass& pass) {
  const std::vector<float>& values = pass.pixels.values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    const PixelPosition at = position_of(pass.pixels, i);
    return unusable(path, "the {} pass has {} in {} of the pixel in row {}, column {}",
                    pass.names->pass, std::isnan(values[i]) ? "NaN" : "an infinite value",
                    pass.names->components[at.channel], at.row, at.column);
  }
  return {};
}

Result<Image<std::uint16_t>> instance_ids(const fs::path& path, const Pass& index, int largest) {
  Image<std::uint16_t> ids(index.pixels.width, index.pixels.height);
  for (std::size_t i = 0; i < ids.values.size(); ++i) {
    const float value = index.pixels.values[i];
    if (!(value >= 0.0F && value <= static_cast<float>(largest) && value == std::trunc(value))) {
      const PixelPosition at = position_of(index.pixels, i);
      return unusable(path,
                      "the index pass has {} in the pixel in row {}, column {}; expected a whole "
                      "number from 0 to {}",
                      value, at.row, at.column, largest);
    }
    ids.values[i] = static_cast<std::uint16_t>(value);
  }
  return ids;
}

/// No file of this size of picture is larger, whatever its channels; a longer one is not read at
/// all.
std::uintmax_t most_file_bytes(const PassExpectation& expected) {
  constexpr std::uintmax_t kHeader = 1 << 20;
  const auto width = static_cast<std::uintmax_t>(expected.width);
  const auto height = static_cast<std::uintmax_t>(expected.height);
  return kHeader + (width + 1) * height * kMostChannels * sizeof(float);
}

}  // namespace

Result<FramePasses> read_passes(const fs::path& path, const PassExpectation& expected) {
  assert(expected.width > 0 && expected.height > 0 && expected.max_instance_id <= 65535);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return unusable(path, "cannot read the rendered passes: {}", error.message());
  if (size > most_file_bytes(expected)) {
    return unusable(path, "{} bytes are too many for {} x {} pixels", size, expected.width,
                    expected.height);
  }
  const Result<std::string> bytes = read_file(path);
  if (!bytes && bytes.error().kind == ErrorKind::kExhausted) return forward_error(bytes);
  if (!bytes) return unusable(path, "{}", bytes.error().message);
  if (const char* fault = exr_header_fault(*bytes)) return unusable(path, "{}", fault);

  Result<std::vector<Pass>> passes = read_file_passes(path, *bytes, expected);
  if (!passes) return forward_error(passes);

  FramePasses frame;
  for (Pass& pass : *passes) {
    if (Status finite = check_finite(path, pass); !finite) return forward_error(finite);
    if (pass.names == &kIndex) {
      Result<Image<std::uint16_t>> ids = instance_ids(path, pass, expected.max_instance_id);
      if (!ids) return forward_error(ids);
      frame.instance_ids = std::move(*ids);
      frame.pixel_hashes[pass.names->pass] = pixel_hash(frame.instance_ids, pass.component_list());
      continue;
    }
    if (pass.names == &kSamples) {
      frame.sample_shares = std::move(pass.pixels);
      continue;
    }
    frame.pixel_hashes[pass.names->pass] =
        pixel_hash(pass.pixels, pass.half ? "half" : "float", pass.component_list());
    if (pass.names == &kCombined) frame.combined = std::move(pass.pixels);
    if (pass.names == &kDepth) frame.depth = std::move(pass.pixels);
    if (pass.names == &kNormal) frame.normal = std::move(pass.pixels);
  }
  return frame;
}

}  // namespace seedframe
