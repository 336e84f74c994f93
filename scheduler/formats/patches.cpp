#include "formats/patches.h"

#include "formats/class_folders.h"
#include "image/crop.h"
#include "image/png_file.h"
#include "image_files/resampling.h"

namespace seedframe {
namespace {

class Patches : public ExportFormat {
 public:
  Patches(const Dataset& dataset, const ExportOptions& options)
      : dataset_(dataset), options_(options), folders_(class_folders(dataset.categories)) {}

  FrameParts needs() const override { return {.image_pixels = true}; }

  std::vector<std::filesystem::path> folders() const override {
    std::vector<std::filesystem::path> folders;
    for (const SplitShare& split : options_.splits) {
      for (const std::string& folder : folders_) {
        folders.push_back(std::filesystem::path(split.name) / folder);
      }
    }
    return folders;
  }

  bool is_common_file(const std::string& path) const override { return path == "classes.json"; }

  Result<FrameRecord> encode(const ExportFrame& frame) const override {
    FrameRecord record;
    record.counts = frame.counts;
    for (const ExportInstance& instance : frame.instances) {
      const auto pixels = patch(frame, instance);
      if (!pixels) return forward_error(pixels);
      record.files.push_back({path(frame, instance), encode_png(*pixels)});
    }
    return record;
  }

  Status finish(ExportFolder& folder, ExportSummary&) const override {
    Json classes = Json::array();
    for (std::size_t k = 0; k < folders_.size(); ++k) {
      classes.push_back({{"folder", folders_[k]}, {"name", dataset_.categories[k]}});
    }
    return folder.write("classes.json", readable_json(classes));
  }

  std::vector<std::string> differences(const ExportFrame& frame,
                                       const WrittenFrame& written) const override {
    std::vector<std::string> found;
    for (const ExportInstance& instance : frame.instances) {
      const std::string name = path(frame, instance);
      const auto png = decode_png8(written.file(name), name);
      if (!png) {
        found.push_back(png.error().message);
        continue;
      }
      const auto expected = patch(frame, instance);
      if (!expected) return {expected.error().message};
      if (png->width != expected->width || png->height != expected->height ||
          png->values != expected->values) {
        found.push_back(name + " is not the object's patch");
      }
    }
    if (written.files.size() != frame.instances.size()) {
      found.push_back(
          fmt::format("{} patches instead of {}", written.files.size(), frame.instances.size()));
    }
    return found;
  }

 private:
  std::string path(const ExportFrame& frame, const ExportInstance& instance) const {
    return fmt::format("{}/{}/{}_{:05}.png", frame.split,
                       folders_[static_cast<std::size_t>(instance.label->category) - 1], frame.stem,
                       instance.label->id);
  }

  Result<Image<std::uint8_t>> patch(const ExportFrame& frame,
                                    const ExportInstance& instance) const {
    const PixelRect& box = instance.box();
    Image<std::uint8_t> rectangle =
        cropped(*frame.loaded.image, box.x, box.y, box.width, box.height);
    if (options_.patch_size == 0) return rectangle;
    return resampled(rectangle, options_.patch_size, options_.patch_size);
  }

  const Dataset& dataset_;
  const ExportOptions& options_;
  std::vector<std::string> folders_;
};

}  // namespace

Result<std::unique_ptr<ExportFormat>> make_patches(const Dataset& dataset,
                                                   const ExportOptions& options) {
  if (!dataset.has_images) {
    return fail(ErrorKind::kInput,
                "patches are cut out of images, and campaign '{}' has labels only (labels: "
                "geometry)",
                dataset.name);
  }
  return std::make_unique<Patches>(dataset, options);
}

}  // namespace seedframe
