#include "formats/patches.h"

#include <algorithm>
#include <map>

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
    for (const SplitShare& split : options_.splits) folders.emplace_back(split.name);
    return folders;
  }

  Result<FrameRecord> encode(const ExportFrame& frame) const override {
    FrameRecord record;
    const int target = frame.loaded.labels.target;
    record.counts = count_instances(
        frame, [target](const InstanceLabel& label) { return target == 0 || label.id == target; });
    for (const ExportInstance* instance : shown(frame)) {
      const auto pixels = patch(frame, *instance);
      if (!pixels) return forward_error(pixels);
      record.files.push_back({path(frame, *instance), encode_png(*pixels)});
    }
    return record;
  }

  /// ImageFolder refuses a folder without images, and numbers the classes by the folders that are
  /// there: a class has one in every split if it has a patch in any.
  Result<CommonPart> common_part(const ExportSummary& summary) const override {
    CommonPart common;
    Json classes = Json::array();
    std::string nowhere;
    std::map<std::string, std::string> empty;  // names of classes by split
    const auto add_name = [](std::string& list, const std::string& name) {
      list += fmt::format("{}'{}'", list.empty() ? "" : ", ", name);
    };
    for (std::size_t k = 0; k < folders_.size(); ++k) {
      const std::string& name = dataset_.categories[k];
      classes.push_back({{"folder", folders_[k]}, {"name", name}});
      const auto holds = [&](const SplitSummary& split) {
        return summary.folders.count(std::filesystem::path(split.split) / folders_[k]) > 0;
      };
      if (std::none_of(summary.splits.begin(), summary.splits.end(), holds)) {
        add_name(nowhere, name);
        continue;
      }
      for (const SplitSummary& split : summary.splits) {
        common.folders.push_back(std::filesystem::path(split.split) / folders_[k]);
        if (!holds(split)) add_name(empty[split.split], name);
      }
    }
    if (!nowhere.empty()) {
      common.warnings.push_back(
          fmt::format("patches: no patch shows {}: such classes have no folder", nowhere));
    }
    for (const auto& [split, names] : empty) {
      common.warnings.push_back(
          fmt::format("patches: no patch of {} shows {}: torchvision's ImageFolder loads it with "
                      "allow_empty=True",
                      split, names));
    }
    common.files["classes.json"] = readable_json(classes);
    return common;
  }

  std::vector<std::string> differences(const ExportFrame& frame,
                                       const WrittenFrame& written) const override {
    std::vector<std::string> found;
    const std::vector<const ExportInstance*> instances = shown(frame);
    for (const ExportInstance* instance : instances) {
      const std::string name = path(frame, *instance);
      const auto png = decode_png8(written.file(name), name);
      if (!png) {
        found.push_back(png.error().message);
        continue;
      }
      const auto expected = patch(frame, *instance);
      if (!expected) return {expected.error().message};
      if (png->width != expected->width || png->height != expected->height ||
          png->values != expected->values) {
        found.push_back(name + " is not the object's patch");
      }
    }
    if (written.files.size() != instances.size()) {
      found.push_back(
          fmt::format("{} patches instead of {}", written.files.size(), instances.size()));
    }
    return found;
  }

 private:
  /// A frame that was cut to one instance is a patch of that alone.
  static std::vector<const ExportInstance*> shown(const ExportFrame& frame) {
    const int target = frame.loaded.labels.target;
    std::vector<const ExportInstance*> shown;
    for (const ExportInstance& instance : frame.instances) {
      if (target == 0 || instance.label->id == target) shown.push_back(&instance);
    }
    return shown;
  }

  std::string path(const ExportFrame& frame, const ExportInstance& instance) const {
    return fmt::format("{}/{}/{}_{:05}.png", frame.split,
                       folders_[static_cast<std::size_t>(instance.label->category) - 1], frame.stem,
                       instance.label->id);
  }

  Result<Image<std::uint8_t>> patch(const ExportFrame& frame,
                                    const ExportInstance& instance) const {
    const Image<std::uint8_t>& image = *frame.loaded.image;
    const bool is_target = instance.label->id == frame.loaded.labels.target;
    const PixelRect box = is_target ? PixelRect{0, 0, image.width, image.height} : instance.box();
    Image<std::uint8_t> rectangle = cropped(image, box);
    if (options_.patch_size == 0) return rectangle;
    if (box.width == options_.patch_size && box.height == options_.patch_size) return rectangle;
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
