// A small finished campaign on disk: frames with known masks, for the tests of the exporters.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "annotate/rle.h"
#include "base/canonical_json.h"
#include "base/files.h"
#include "base/sha256.h"
#include "export/export_run.h"
#include "formats/formats.h"
#include "frames/campaign_files.h"
#include "frames/manifest.h"
#include "image/png_file.h"
#include "tests/annotate/mask_cases.h"

namespace seedframe {

namespace fs = std::filesystem;

/// Without forcing anything to the disk, which would be most of the tests' time.
inline bool write_quickly(const fs::path& path, const std::string& bytes) {
  std::ofstream stream(path, std::ios::binary);
  stream << bytes;
  stream.close();
  return !stream.fail();
}

inline InstanceSpec labelled(std::string name, int id, int category) {
  InstanceSpec spec;
  spec.asset = name.substr(0, name.find('/'));
  spec.name = std::move(name);
  spec.id = id;
  spec.category = category;
  return spec;
}

/// Instances that every synthetic frame knows, seen or not. 4 is a distractor.
inline std::vector<InstanceSpec> synthetic_instances() {
  return {labelled("ground/0", 0, 0), labelled("bolt/0", 3, 1),  labelled("bolt/1", 1, 1),
          labelled("nut/0", 2, 2),    labelled("rock/0", 4, 0),  labelled("gear/0", 40, 3),
          labelled("bolt/2", 300, 1), labelled("hidden/0", 6, 2)};
}

/// What a frame was made of, kept in memory to compare with what a decoder finds in an export.
struct Truth {
  IdImage ids;
  FrameLabels labels;
};

class SyntheticDataset {
 public:
  explicit SyntheticDataset(fs::path folder) : folder_(std::move(folder)) {
    dataset_.name = "parts";
    dataset_.keypoints.resize(4);
    dataset_.keypoints[0] = {{"head", "tip"}, {{0, 1}}, {}};
    dataset_.frames = [this] {
      return [this, next = std::size_t{0}]() mutable -> Result<std::optional<CommittedFrame>> {
        if (next == frames_.size()) return std::nullopt;
        return frames_[next++];
      };
    };
    // The second name needs quotes in YAML, the fourth in JSON; the fourth never appears.
    dataset_.categories = {"bolt", "no", "gear", "say \"über\""};
  }

  const Dataset& dataset() const { return dataset_; }
  Dataset& dataset() { return dataset_; }
  const std::vector<CommittedFrame>& frames() const { return frames_; }
  std::vector<CommittedFrame>& frames() { return frames_; }
  const Truth& truth(std::int64_t index) const { return truths_.at(index); }
  fs::path frame_folder(std::int64_t index) const { return CampaignFiles(folder_).frame(index); }

  void add_frame(std::int64_t index, int scene, const IdImage& ids) {
    FrameSpec spec;
    spec.render.width = ids.width;
    spec.render.height = ids.height;
    spec.instances = synthetic_instances();
    auto labels = make_labels(spec, dataset_.categories, ids);
    ASSERT_TRUE(labels) << labels.error().message;
    add_whole_silhouettes(*labels);
    Image<std::uint8_t> image(ids.width, ids.height, 3);
    std::mt19937_64 random(static_cast<std::uint64_t>(index));
    for (std::uint8_t& value : image.values) value = static_cast<std::uint8_t>(random());
    const fs::path folder = frame_folder(index);
    ASSERT_TRUE(make_folders(folder));
    frames_.push_back({index, scene, folder, std::string(60, 'f') + std::to_string(1000 + index)});
    truths_[index] = {ids, *labels};
    ASSERT_TRUE(write_quickly(folder / "image.png", encode_png(image)));
    ASSERT_TRUE(write_quickly(folder / frame_files::kInstances, encode_png(ids)));
    ASSERT_TRUE(write_quickly(folder / frame_files::kLabels, readable_json(to_json(*labels))));
    write_manifest(frames_.back());
  }

  /// As if the files that are there had been written so.
  static void write_manifest(const CommittedFrame& frame) {
    Manifest manifest;
    manifest.frame_id = frame.frame_id;
    for (const char* name : {"image.png", frame_files::kInstances, frame_files::kLabels}) {
      const auto bytes = read_file(frame.folder / name);
      if (bytes) manifest.files[name] = {bytes->size(), sha256_hex(*bytes)};
    }
    ASSERT_TRUE(
        write_quickly(frame.folder / frame_files::kManifest, readable_json(to_json(manifest))));
  }

  /// Ten frames of five scenes; an index is missing, as after a frame that failed. Frame 3 is
  /// background, frame 8 has two bolts with one box.
  void add_ten_frames() {
    for (const std::int64_t index : {0, 1, 2, 3, 5, 6, 7, 8, 9, 10}) {
      const int scene = static_cast<int>(index) / 2;
      if (index == 3) {
        IdImage ids(160, 120);
        ids.at(5, 5) = 4;
        add_frame(index, scene, ids);
      } else if (index == 8) {
        add_frame(index, scene, crossed_bolts());
      } else {
        add_frame(index, scene, discs(static_cast<std::uint64_t>(index)));
      }
    }
  }

  /// Bolts 1 and 3 cross: other pixels, the same box. With them a gear of one pixel, in the corner.
  static IdImage crossed_bolts() {
    IdImage ids(160, 120);
    for (int i = 0; i < 41; ++i) {
      for (const int thick : {0, 1}) {
        ids.at(30 + i, std::min(50 + i + thick, 90)) = 1;
        ids.at(30 + i, std::max(90 - i - thick, 50)) = 3;
      }
    }
    ids.at(119, 159) = 40;
    return ids;
  }

  /// Discs over discs: holes, separate parts, partly out of view.
  static IdImage discs(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    IdImage ids(160, 120);
    const std::vector<int> painted = {3, 1, 2, 4, 40, 300, 4, 3, 4};
    for (const int id : painted) {
      const double y = static_cast<double>(random() % 120);
      const double x = static_cast<double>(random() % 160);
      const double radius = 8.0 + static_cast<double>(random() % 24);
      for (int row = 0; row < ids.height; ++row) {
        for (int column = 0; column < ids.width; ++column) {
          const bool hole = in_disc(row, column, y, x, radius / 3) && id == 40;
          if (in_disc(row, column, y, x, radius) && !hole) {
            ids.at(row, column) = static_cast<std::uint16_t>(id);
          }
        }
      }
    }
    return ids;
  }

 private:
  /// Every silhouette is the box of what is visible, and a column beyond it on the left, outside
  /// the image for what touches its edge. Bolts have a visible head and a hidden tip.
  static void add_whole_silhouettes(FrameLabels& labels) {
    for (InstanceLabel& label : labels.instances) {
      AmodalLabel& amodal = label.amodal.emplace();
      if (label.area_px == 0) continue;
      const PixelRect& box = label.box;
      amodal.box = {box.x - 1, box.y, box.width + 1, box.height};
      amodal.area_px = amodal.box.area();
      amodal.in_image_px = box.x > 0 ? amodal.area_px : amodal.area_px - box.height;
      amodal.rle = rle_string(
          {amodal.box.height, amodal.box.width, {0, static_cast<std::uint32_t>(amodal.area_px)}});
      amodal.pose.translation_m = {0.1, 0.2, -1.0};
      if (label.category != 1) continue;
      label.keypoints = {{"head", {box.x + 0.5, box.y + 0.25}, Visibility::kVisible},
                         {"tip", {box.x + 0.75, box.y + 0.5}, Visibility::kHidden}};
    }
  }

  fs::path folder_;
  Dataset dataset_;
  std::vector<CommittedFrame> frames_;
  std::map<std::int64_t, Truth> truths_;
};

/// Relative path and bytes of every file below a folder.
inline std::map<std::string, std::string> files_below(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[fs::relative(entry.path(), folder).string()] = *read_file(entry.path());
  }
  return files;
}

/// Visible instances that an export must hold: with a category and enough pixels, in order.
inline std::vector<InstanceLabel> exported_instances(const Truth& truth, int min_pixels = 1) {
  std::vector<InstanceLabel> instances;
  for (const InstanceLabel& label : truth.labels.instances) {
    if (label.category > 0 && label.area_px >= min_pixels) instances.push_back(label);
  }
  return instances;
}

/// Runs one format; its summary.
inline Result<ExportSummary> export_one(const Dataset& dataset, const std::string& format,
                                        const ExportOptions& options) {
  const auto entry = find_format(export_formats(), format);
  if (!entry) return forward_error(entry);
  auto outcome = run_export(dataset, {*entry}, options);
  if (!outcome) return forward_error(outcome);
  return std::move(outcome->written.front());
}

}  // namespace seedframe
