#include "config/image_section.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/nearest_name.h"

namespace seedframe {
namespace {

constexpr int kLargestWebpSide = 16'383;

ImageFormat read_format(SectionReader& section) {
  const std::string name = section.text("format", "png");
  const auto format = image_format_of(name);
  if (!format) {
    section.errors().add(section.node().find("format")->place(),
                         "expected one of png, jpeg, webp, tiff, found '" + name + "'" +
                             did_you_mean(name, {"png", "jpeg", "webp", "tiff"}));
  }
  return format.value_or(ImageFormat::kPng);
}

/// The key, if it is there; a format that does not know it is an error.
std::optional<ConfigNode> find_for(SectionReader& section, const char* key, ImageFormat format,
                                   std::initializer_list<ImageFormat> formats, const char* whose) {
  auto node = section.find(key);
  if (!node || std::find(formats.begin(), formats.end(), format) != formats.end()) return node;
  section.errors().add(node->place(), fmt::format("{} is of {} only, and the format is {}", key,
                                                  whose, name_of(format)));
  return std::nullopt;
}

TiffCompression read_tiff_compression(const ConfigNode& node, Diagnostics& errors) {
  const auto compression = tiff_compression_of(node.is_scalar() ? node.text() : "");
  if (!compression) {
    errors.add(node.place(), "expected none, lzw or zip for a tiff, found " + node.description());
  }
  return compression.value_or(TiffCompression::kZip);
}

ImageEncoding read_encoding(SectionReader& section, const RenderConfig& render) {
  using enum ImageFormat;
  Diagnostics& errors = section.errors();
  ImageEncoding encoding;
  const ImageFormat format = encoding.format = read_format(section);
  if (find_for(section, "quality", format, {kJpeg, kWebp}, "jpeg and webp")) {
    encoding.quality = static_cast<int>(section.integer("quality", encoding.quality, 1, 100));
  }
  if (const auto node = find_for(section, "compression", format, {kPng, kTiff}, "png and tiff")) {
    if (format == kPng) {
      encoding.compression = static_cast<int>(section.integer("compression", 0, 0, 9));
    } else {
      encoding.tiff = read_tiff_compression(*node, errors);
    }
  }
  if (format == kWebp && std::max(render.width, render.height) > kLargestWebpSide) {
    errors.add(section.node().find("format")->place(),
               fmt::format("a webp has at most {} pixels a side, and the image has {} x {}",
                           kLargestWebpSide, render.width, render.height));
  }
  return encoding;
}

}  // namespace

ImageConfig read_image(SectionReader& campaign, const RenderConfig& render) {
  ImageConfig image;
  const auto node = campaign.find("image");
  if (!node) return image;
  image.place = node->place();
  SectionReader section(*node, campaign.errors());
  ImageSettings& settings = image.settings;
  settings.display = section.text("display", settings.display);
  settings.view = section.text("view", settings.view);
  settings.look = section.text("look", settings.look);
  settings.exposure_stops = section.constant("exposure_stops", settings.exposure_stops);
  settings.gamma = section.positive("gamma", settings.gamma);
  if (const auto ocio = section.find("ocio_config")) {
    image.ocio_config = ocio->named_path(campaign.errors());
    std::error_code missing;
    if (image.ocio_config && !std::filesystem::is_regular_file(*image.ocio_config, missing)) {
      campaign.errors().add(ocio->place(), "expected the path of an OpenColorIO config, found " +
                                               ocio->description() +
                                               " (paths start at the config's folder)");
    }
  }
  image.encoding = read_encoding(section, render);
  section.refuse_other_keys();
  return image;
}

}  // namespace seedframe
