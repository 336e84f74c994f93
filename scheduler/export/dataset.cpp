#include "export/dataset.h"

#include <algorithm>
#include <unordered_map>

#include "annotate/extents.h"
#include "base/files.h"
#include "base/sha256.h"
#include "frames/campaign_files.h"
#include "image/exr_file.h"
#include "image/png_file.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr const char* kRemedy = "'seedframe resume --verify' renders the frame again";
constexpr std::size_t kKeyDigits = 32;

using ExtentsById = std::unordered_map<int, InstanceExtent>;

Status check_label(const DatasetFrame& frame, const InstanceLabel& label,
                   const InstanceExtent& pixels) {
  const auto complain = [&](const std::string& said, const std::string& found) {
    return fail(ErrorKind::kCorrupt,
                "frame {}, instance {} ('{}'): labels.json says {}, instances.png has {}; {}",
                frame.index, label.id, label.name, said, found, kRemedy);
  };
  if (label.area_px != pixels.area_px) {
    return complain(fmt::format("{} pixels", label.area_px), fmt::format("{}", pixels.area_px));
  }
  if (label.box != pixels.box) {
    const auto text = [](const PixelBox& box) {
      return fmt::format("[{}, {}, {}, {}]", box.x, box.y, box.width, box.height);
    };
    return complain("the box " + text(label.box), text(pixels.box));
  }
  return {};
}

Status check_categories(const Dataset& dataset, const DatasetFrame& frame,
                        const FrameLabels& labels) {
  if (labels.categories == dataset.categories) return {};
  for (const std::string& category : labels.categories) {
    const auto& now = dataset.categories;
    if (std::find(now.begin(), now.end(), category) != now.end()) continue;
    return fail(ErrorKind::kCorrupt,
                "frame {} was labelled with a class '{}', which the campaign's config no longer "
                "has: put it back into 'categories', or submit the campaign anew",
                frame.index, category);
  }
  return fail(ErrorKind::kCorrupt,
              "frame {} was labelled with {} classes, the campaign's config has {} or another "
              "order of them: make 'categories' as they were, or submit the campaign anew",
              frame.index, labels.categories.size(), dataset.categories.size());
}

Status check_agreement(const DatasetFrame& frame, const LoadedFrame& loaded) {
  const Image<std::uint16_t>& ids = loaded.instance_ids;
  const FrameLabels& labels = loaded.labels;
  if (ids.width != labels.width || ids.height != labels.height) {
    return fail(ErrorKind::kCorrupt, "frame {}: labels.json says {}x{}, instances.png is {}x{}; {}",
                frame.index, labels.width, labels.height, ids.width, ids.height, kRemedy);
  }
  ExtentsById extents;
  for (const InstanceExtent& extent : measure_extents(ids)) extents.emplace(extent.id, extent);
  for (const InstanceLabel& label : labels.instances) {
    const auto found = extents.find(label.id);
    const InstanceExtent pixels = found == extents.end() ? InstanceExtent{} : found->second;
    if (Status same = check_label(frame, label, pixels); !same) return same;
    if (found != extents.end()) extents.erase(found);
  }
  if (extents.empty()) return {};
  const auto least =
      std::min_element(extents.begin(), extents.end(),
                       [](const auto& a, const auto& b) { return a.first < b.first; });
  return fail(ErrorKind::kCorrupt,
              "frame {}, instance {}: instances.png has {} pixels of it, labels.json does not "
              "know it; {}",
              frame.index, least->first, least->second.area_px, kRemedy);
}

/// The same error, with the frame named in front.
template <class T>
tl::unexpected<Error> in_frame(const DatasetFrame& frame, const Result<T>& result) {
  return fail(ErrorKind::kCorrupt, "frame {}: {}", frame.index, result.error().message);
}

Status check_hash(const DatasetFrame& frame, const char* name, const Manifest& manifest,
                  const std::string& sha256) {
  const auto file = manifest.files.find(name);
  if (file != manifest.files.end() && file->second.sha256 == sha256) return {};
  return fail(
      ErrorKind::kCorrupt, "frame {}: {} {}; {}", frame.index, (frame.folder / name).string(),
      file == manifest.files.end() ? "is not in the frame's manifest" : "has changed", kRemedy);
}

Result<std::string> read_checked(const DatasetFrame& frame, const char* name,
                                 const Manifest& manifest) {
  auto bytes = read_file(frame.folder / name);
  if (!bytes) {
    return fail(ErrorKind::kCorrupt, "frame {}: {}; {}", frame.index, bytes.error().message,
                kRemedy);
  }
  const Status same = check_hash(frame, name, manifest, sha256_hex(*bytes));
  if (!same) return forward_error(same);
  return bytes;
}

Status check_file(const DatasetFrame& frame, const char* name, const Manifest& manifest) {
  const auto sha256 = sha256_of_file(frame.folder / name);
  if (!sha256) {
    return fail(ErrorKind::kCorrupt, "frame {}: {}; {}", frame.index, sha256.error().message,
                kRemedy);
  }
  return check_hash(frame, name, manifest, *sha256);
}

void add_pairs(const std::vector<std::array<std::string, 2>>& pairs,
               const std::vector<std::string>& names, std::vector<std::array<int, 2>>& out) {
  const auto index = [&](const std::string& name) {
    return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  for (const auto& [from, to] : pairs) {
    const std::array<int, 2> pair = {index(from), index(to)};
    if (std::find(out.begin(), out.end(), pair) == out.end()) out.push_back(pair);
  }
}

}  // namespace

std::vector<ClassKeypoints> class_keypoints(const std::vector<OfferedAsset>& assets,
                                            const std::vector<std::string>& categories) {
  std::vector<ClassKeypoints> keypoints(categories.size());
  for (std::size_t k = 0; k < categories.size(); ++k) {
    ClassKeypoints& points = keypoints[k];
    for (const OfferedAsset& offered : assets) {
      if (offered.categories.count(categories[k]) == 0) continue;
      const KeypointSet& set = offered.asset->keypoints;
      for (const Keypoint& point : set.points) {
        if (std::find(points.names.begin(), points.names.end(), point.name) == points.names.end()) {
          points.names.push_back(point.name);
        }
      }
      add_pairs(set.skeleton, points.names, points.skeleton);
      add_pairs(set.mirrored, points.names, points.mirrored);
    }
  }
  return keypoints;
}

Result<FrameFiles> FrameFiles::open(const Dataset& dataset, const DatasetFrame& frame,
                                    const FrameParts& parts) {
  FrameFiles files;
  files.dataset_ = &dataset;
  files.frame_ = &frame;
  files.parts_ = parts;
  auto manifest = verify_frame(frame.folder, frame.frame_id, VerifyDepth::kSizes);
  if (!manifest) {
    return fail(ErrorKind::kCorrupt, "frame {}: {}; {}", frame.index, manifest.error().message,
                kRemedy);
  }
  files.manifest_ = std::move(*manifest);
  files.key_ =
      sha256_hex(fmt::format("{}\n{}", frame.scene, canonical_json(to_json(files.manifest_))))
          .substr(0, kKeyDigits);
  auto labels = read_checked(frame, frame_files::kLabels, files.manifest_);
  if (!labels) return forward_error(labels);
  files.labels_ = std::move(*labels);
  auto instances = read_checked(frame, frame_files::kInstances, files.manifest_);
  if (!instances) return forward_error(instances);
  files.instances_ = std::move(*instances);
  if (parts.image_file || parts.image_pixels) {
    const Status image = check_file(frame, frame_files::kImage, files.manifest_);
    if (!image) return forward_error(image);
  }
  if (parts.depth) {
    const Status depth = check_file(frame, frame_files::kDepth, files.manifest_);
    if (!depth) return forward_error(depth);
  }
  return files;
}

std::string FrameFiles::sha256(const char* name) const {
  const auto found = manifest_.files.find(name);
  return found == manifest_.files.end() ? std::string() : found->second.sha256;
}

Result<LoadedFrame> FrameFiles::load() const {
  const std::string labels_path = (frame_->folder / frame_files::kLabels).string();
  const auto json = parse_json(labels_, labels_path);
  if (!json) return in_frame(*frame_, json);
  auto labels = labels_from_json(*json, labels_path);
  if (!labels) return in_frame(*frame_, labels);
  auto ids = decode_png16(instances_, (frame_->folder / frame_files::kInstances).string());
  if (!ids) return in_frame(*frame_, ids);
  LoadedFrame loaded{std::move(*labels), std::move(*ids), {}, {}};
  if (Status known = check_categories(*dataset_, *frame_, loaded.labels); !known) {
    return forward_error(known);
  }
  if (Status agree = check_agreement(*frame_, loaded); !agree) return forward_error(agree);
  if (parts_.image_pixels) {
    auto image = read_png8(frame_->folder / frame_files::kImage);
    if (!image) return in_frame(*frame_, image);
    loaded.image = std::move(*image);
  }
  if (parts_.depth) {
    auto depth = read_exr_channel(frame_->folder / frame_files::kDepth, "Z");
    if (!depth) return in_frame(*frame_, depth);
    loaded.depth = std::move(*depth);
  }
  return loaded;
}

}  // namespace seedframe
