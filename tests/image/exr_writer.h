// Writes the EXR files that a worker might leave: the right ones, and all the wrong ones.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

namespace seedframe {

struct ExrFile {
  struct ChannelValues {
    Imf::PixelType type = Imf::FLOAT;
    std::vector<float> values;  ///< row by row
  };

  int width = 3;
  int height = 2;
  int first_column = 0;
  Imf::Compression compression = Imf::ZIP_COMPRESSION;
  std::string note;  ///< the attribute "Note"; empty: none
  std::map<std::string, ChannelValues> channels;

  std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }

  /// Every pixel of the channel has the value.
  void fill(const std::string& name, Imf::PixelType type, float value) {
    channels[name] = {type, std::vector<float>(pixels(), value)};
  }
  float& at(const std::string& name, int row, int column) {
    return channels.at(name).values.at(static_cast<std::size_t>(row * width + column));
  }

  void write(const std::filesystem::path& path) const {
    const Imath::Box2i window({first_column, 0}, {first_column + width - 1, height - 1});
    Imf::Header header(window, window);
    header.compression() = compression;
    if (!note.empty()) header.insert("Note", Imf::StringAttribute(note));
    Imf::FrameBuffer buffer;
    std::map<std::string, std::vector<half>> halves;
    for (const auto& [name, channel] : channels) {
      header.channels().insert(name, Imf::Channel(channel.type));
      const void* first = channel.values.data();
      std::size_t stride = sizeof(float);
      if (channel.type == Imf::HALF) {
        halves[name].assign(channel.values.begin(), channel.values.end());
        first = halves[name].data();
        stride = sizeof(half);
      }
      char* base = static_cast<char*>(const_cast<void*>(first)) -
                   static_cast<std::ptrdiff_t>(stride) * first_column;
      buffer.insert(
          name, Imf::Slice(channel.type, base, stride, stride * static_cast<std::size_t>(width)));
    }
    Imf::OutputFile file(path.c_str(), header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(height);
  }
};

/// What Blender 3.4 writes, with small numbers: Combined as half, index, depth and normal as float.
inline ExrFile blender_exr(int width = 3, int height = 2, const std::string& layer = "ViewLayer.") {
  ExrFile file;
  file.width = width;
  file.height = height;
  for (const char* component : {"R", "G", "B", "A"}) {
    file.fill(layer + "Combined." + component, Imf::HALF, 1.0F);
  }
  file.fill(layer + "IndexOB.X", Imf::FLOAT, 0.0F);
  file.fill(layer + "Depth.Z", Imf::FLOAT, 1e10F);
  for (const char* component : {"X", "Y", "Z"}) {
    file.fill(layer + "Normal." + component, Imf::FLOAT, 0.0F);
  }
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      file.at(layer + "Combined.R", row, column) = 0.25F * static_cast<float>(column);
      file.at(layer + "Combined.G", row, column) = 0.5F * static_cast<float>(row);
      file.at(layer + "Depth.Z", row, column) = 2.0F + static_cast<float>(row);
      file.at(layer + "IndexOB.X", row, column) = static_cast<float>((row * width + column) % 5);
      file.at(layer + "Normal.Z", row, column) = 1.0F;
    }
  }
  return file;
}

}  // namespace seedframe
