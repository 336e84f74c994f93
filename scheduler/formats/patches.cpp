#include "formats/patches.h"

#include <algorithm>
#include <map>
#include <mutex>

#include "base/nearest_name.h"
#include "export/frame_pipeline.h"
#include "export/split.h"
#include "formats/class_folders.h"
#include "formats/class_windows.h"
#include "formats/patch_choice.h"
#include "image/crop.h"
#include "image/png_file.h"
#include "image_files/resampling.h"

namespace seedframe {
namespace {

struct PatchClasses {
  std::vector<int> asked_for;  ///< in the campaign's order
  std::vector<WindowRule> windows;
};

Result<int> category_named(const Dataset& dataset, const char* option, const std::string& name) {
  const auto found = std::find(dataset.categories.begin(), dataset.categories.end(), name);
  if (found == dataset.categories.end()) {
    return fail(ErrorKind::kInput, "{}: campaign '{}' has no class '{}'{}", option, dataset.name,
                name, did_you_mean(name, dataset.categories));
  }
  return static_cast<int>(found - dataset.categories.begin()) + 1;
}

Result<PatchClasses> classes_of(const Dataset& dataset, const ExportOptions& options) {
  PatchClasses classes;
  for (const std::string& name : options.patch_classes) {
    const auto category = category_named(dataset, "--classes", name);
    if (!category) return forward_error(category);
    classes.asked_for.push_back(*category);
  }
  if (options.patch_classes.empty()) {
    for (std::size_t k = 1; k <= dataset.categories.size(); ++k) {
      classes.asked_for.push_back(static_cast<int>(k));
    }
  }
  std::sort(classes.asked_for.begin(), classes.asked_for.end());
  classes.asked_for.erase(std::unique(classes.asked_for.begin(), classes.asked_for.end()),
                          classes.asked_for.end());
  std::vector<int> before;
  for (const std::string& name : options.windows) {
    const auto category = category_named(dataset, "--windows", name);
    if (!category) return forward_error(category);
    if (!std::binary_search(classes.asked_for.begin(), classes.asked_for.end(), *category)) {
      return fail(ErrorKind::kInput, "--windows {}: name it with --classes, too", name);
    }
    if (std::find(before.begin(), before.end(), *category) != before.end()) {
      return fail(ErrorKind::kInput, "--windows: {} is named twice", name);
    }
    classes.windows.push_back({*category, before, options.min_side});
    before.push_back(*category);
  }
  return classes;
}

/// A piece of a frame's image.
struct Patch {
  int category = 0;
  int number = 0;  ///< as in PatchCandidate
  PixelRect box;
};

/// All patches that a frame has, by category and number, and what was left out.
struct FramePatches {
  std::vector<Patch> patches;
  Counts counts{};
};

class Patches : public ExportFormat {
 public:
  Patches(const Dataset& dataset, const ExportOptions& options, const PatchClasses& classes)
      : dataset_(dataset),
        options_(options),
        folders_(class_folders(dataset.categories)),
        asked_for_(classes.asked_for),
        windows_(classes.windows),
        draws_(dataset.seed, "export/patches") {
    for (const WindowRule& rule : windows_) {
      const std::string& name = dataset.categories[static_cast<std::size_t>(rule.category) - 1];
      sides_.emplace_back(dataset.seed, "export/window-sides/" + name);
      places_.emplace_back(dataset.seed, "export/window-places/" + name);
    }
  }

  /// Looks at all frames, and chooses. Errors are those of choose_patches, or of the frames.
  Status choose();

  FrameParts needs() const override { return {.image_pixels = true}; }
  /// With a number for each class a frame's patches depend on all others.
  bool reusable() const override { return options_.per_class == 0; }

  std::vector<std::filesystem::path> folders() const override {
    std::vector<std::filesystem::path> folders;
    for (const SplitShare& split : options_.splits) folders.emplace_back(split.name);
    return folders;
  }

  Result<FrameRecord> encode(const ExportFrame& frame) const override {
    const FramePatches found = chosen_patches(frame);
    FrameRecord record;
    record.counts = found.counts;
    for (const Patch& patch : found.patches) {
      const auto pixels = pixels_of(frame, patch);
      if (!pixels) return forward_error(pixels);
      record.files.push_back({path(frame, patch), encode_png(*pixels)});
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
    for (const int category : asked_for_) {
      const auto k = static_cast<std::size_t>(category) - 1;
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
    const std::vector<Patch> patches = chosen_patches(frame).patches;
    for (const Patch& patch : patches) {
      const std::string name = path(frame, patch);
      const auto png = decode_png8(written.file(name), name);
      if (!png) {
        found.push_back(png.error().message);
        continue;
      }
      const auto expected = pixels_of(frame, patch);
      if (!expected) return {expected.error().message};
      if (png->width != expected->width || png->height != expected->height ||
          png->values != expected->values) {
        found.push_back(name + " is not the object's patch");
      }
    }
    if (written.files.size() != patches.size()) {
      found.push_back(
          fmt::format("{} patches instead of {}", written.files.size(), patches.size()));
    }
    return found;
  }

 private:
  bool asks_for(int category) const {
    return std::find(asked_for_.begin(), asked_for_.end(), category) != asked_for_.end();
  }
  bool has_windows(int category) const {
    return std::any_of(windows_.begin(), windows_.end(),
                       [&](const WindowRule& rule) { return rule.category == category; });
  }

  FramePatches all_patches(const ExportFrame& frame) const {
    FramePatches found;
    // A frame that was cut to one instance is a patch of that alone.
    const int target = frame.loaded.labels.target;
    const auto counts = [&](const InstanceLabel& label) {
      return asks_for(label.category) && !has_windows(label.category) &&
             (target == 0 || label.id == target);
    };
    found.counts = count_instances(frame, counts);
    for (const ExportInstance& instance : frame.instances) {
      if (!counts(*instance.label)) continue;
      const PixelRect box =
          target == 0 ? instance.box()
                      : PixelRect{0, 0, frame.loaded.labels.width, frame.loaded.labels.height};
      if (std::min(box.width, box.height) < options_.min_side) {
        ++at(found.counts, Count::kTooSmall);
      } else {
        found.patches.push_back({instance.label->category, instance.label->id, box});
      }
    }
    if (target == 0 && !windows_.empty()) add_windows(frame, found.patches);
    return found;
  }

  Status add_candidates(const CommittedFrame& frame,
                        std::vector<PatchCandidate>& candidates) const {
    const auto files = FrameReader::open(frame, {});
    if (!files) return forward_error(files);
    auto loaded = files->load(dataset_.categories);
    if (!loaded) return forward_error(loaded);
    const int split = split_of_scene(frame.scene, dataset_.seed, options_.splits);
    const auto selected = select_instances(
        frame, std::move(*loaded), options_.splits[static_cast<std::size_t>(split)].name, options_);
    if (!selected) return forward_error(selected);
    for (const Patch& patch : all_patches(**selected).patches) {
      const std::uint64_t draw = draws_.bits({.scene = static_cast<std::uint32_t>(patch.category),
                                              .frame = static_cast<std::uint32_t>(frame.index),
                                              .copy = static_cast<std::uint32_t>(patch.number)});
      candidates.push_back({frame.index, split, patch.category, patch.number, draw});
    }
    return {};
  }

  void add_windows(const ExportFrame& frame, std::vector<Patch>& patches) const {
    const Image<std::uint8_t> classes = class_image(frame.loaded.labels, frame.loaded.instance_ids);
    for (std::size_t i = 0; i < windows_.size(); ++i) {
      for (int k = 0; k < options_.windows_per_frame; ++k) {
        const auto window = draw_window(classes, windows_[i], sides_[i], places_[i],
                                        {.frame = static_cast<std::uint32_t>(frame.frame.index),
                                         .copy = static_cast<std::uint32_t>(k)});
        if (window) patches.push_back({windows_[i].category, -1 - k, *window});
      }
    }
  }

  FramePatches chosen_patches(const ExportFrame& frame) const {
    FramePatches found = all_patches(frame);
    if (options_.per_class > 0) {
      const auto here = chosen_.find(frame.frame.index);
      const auto is_left = [&](const Patch& patch) {
        return here == chosen_.end() ||
               !std::binary_search(here->second.begin(), here->second.end(),
                                   std::pair(patch.category, patch.number));
      };
      found.patches.erase(std::remove_if(found.patches.begin(), found.patches.end(), is_left),
                          found.patches.end());
    }
    at(found.counts, Count::kAnnotations) = static_cast<std::int64_t>(found.patches.size());
    return found;
  }

  std::string path(const ExportFrame& frame, const Patch& patch) const {
    const std::string& folder = folders_[static_cast<std::size_t>(patch.category) - 1];
    if (patch.number < 0) {
      return fmt::format("{}/{}/{}_window{}.png", frame.split, folder, frame.stem, -patch.number);
    }
    return fmt::format("{}/{}/{}_{:05}.png", frame.split, folder, frame.stem, patch.number);
  }

  Result<Image<std::uint8_t>> pixels_of(const ExportFrame& frame, const Patch& patch) const {
    Image<std::uint8_t> rectangle = cropped(*frame.loaded.image, patch.box);
    if (options_.patch_size == 0) return rectangle;
    return resampled(rectangle, options_.patch_size, options_.patch_size);
  }

  const Dataset& dataset_;
  const ExportOptions& options_;
  std::vector<std::string> folders_;
  std::vector<int> asked_for_;
  std::vector<WindowRule> windows_;
  PhiloxStream draws_;
  std::vector<PhiloxStream> sides_;  ///< one for each of windows_
  std::vector<PhiloxStream> places_;
  std::map<std::int64_t, ChosenPatches> chosen_;  ///< by frame; only with options_.per_class
};

/// A frame on its way through the choice.
struct CandidateTask {
  CommittedFrame frame;
  std::vector<PatchCandidate> candidates;
  Status status;
};

Status Patches::choose() {
  std::vector<PatchCandidate> candidates;
  Status outcome;
  std::int64_t frames = 0;
  FrameCursor cursor = dataset_.frames();
  std::mutex outcome_mutex;  // the cursor may fail while frames are taken
  const auto keep_first = [&](const Status& status) {
    const std::lock_guard lock(outcome_mutex);
    if (outcome) outcome = status;
  };
  run_frame_pipeline<CandidateTask>(
      options_.workers,
      [&]() -> std::shared_ptr<CandidateTask> {
        auto frame = cursor();
        if (!frame) keep_first(forward_error(frame));
        if (!frame || !*frame) return nullptr;
        auto task = std::make_shared<CandidateTask>();
        task->frame = std::move(**frame);
        return task;
      },
      [&](CandidateTask& task) { task.status = add_candidates(task.frame, task.candidates); },
      [&](CandidateTask& task) {
        if (!task.status) keep_first(task.status);
        ++frames;
        candidates.insert(candidates.end(), task.candidates.begin(), task.candidates.end());
      });
  if (!outcome) return outcome;
  PatchDemand demand{options_.per_class,  options_.splits, asked_for_,
                     dataset_.categories, frames,          dataset_.name};
  auto chosen = choose_patches(std::move(candidates), demand);
  if (!chosen) return forward_error(chosen);
  chosen_ = std::move(*chosen);
  return {};
}

}  // namespace

Result<std::unique_ptr<ExportFormat>> make_patches(const Dataset& dataset,
                                                   const ExportOptions& options) {
  if (!dataset.has_images) {
    return fail(ErrorKind::kInput,
                "patches are cut out of images, and campaign '{}' has labels only (labels: "
                "geometry)",
                dataset.name);
  }
  const auto classes = classes_of(dataset, options);
  if (!classes) return forward_error(classes);
  auto patches = std::make_unique<Patches>(dataset, options, *classes);
  if (options.per_class > 0) {
    if (Status chosen = patches->choose(); !chosen) return forward_error(chosen);
  }
  return patches;
}

}  // namespace seedframe
