#include "formats/bop.h"

#include <algorithm>
#include <cmath>

#include "annotate/mask.h"
#include "formats/bop_models.h"
#include "formats/coco_entry.h"
#include "frames/campaign_files.h"
#include "image/png_file.h"
#include "rays/ray_scene.h"

namespace seedframe {
namespace {

// In the order of documents().
enum Document { kCamera, kGroundTruth, kInfo, kCoco, kTargets };

Json matrix_json(const Eigen::Matrix3d& matrix) {
  Json list = Json::array();
  for (Eigen::Index i = 0; i < 9; ++i) list.push_back(matrix(i / 3, i % 3));
  return list;
}

/// From the camera's axes (y up, z towards the viewer) to OpenCV's.
Eigen::DiagonalMatrix<double, 3> opencv_axes() { return {1.0, -1.0, -1.0}; }

/// Depth in 16 bits, and how many millimetres a unit has.
struct ScaledDepth {
  Image<std::uint16_t> units;
  double scale_mm = 0.1;
};

ScaledDepth scaled_depth(const Image<float>& depth_m) {
  constexpr double kMostUnits = 65535.0;
  double deepest = 0.0;
  for (const float depth : depth_m.values) {
    if (depth < kNoDepth) deepest = std::max(deepest, static_cast<double>(depth));
  }
  ScaledDepth out{Image<std::uint16_t>(depth_m.width, depth_m.height)};
  while (std::round(deepest * kMillimetresPerMetre / out.scale_mm) > kMostUnits) {
    out.scale_mm *= 10.0;
  }
  std::transform(depth_m.values.begin(), depth_m.values.end(), out.units.values.begin(),
                 [&](float depth) {
                   if (!(depth < kNoDepth)) return std::uint16_t{0};
                   const double mm = static_cast<double>(depth) * kMillimetresPerMetre;
                   return static_cast<std::uint16_t>(std::round(mm / out.scale_mm));
                 });
  return out;
}

Image<std::uint8_t> mask_image(const Mask& mask) {
  Image<std::uint8_t> image(mask.image_width(), mask.image_height());
  const PixelRect& box = mask.box();
  for (int row = box.y; row < box.end_y(); ++row) {
    for (int column = box.x; column < box.end_x(); ++column) {
      if (mask.at(row, column)) image.at(row, column) = 255;
    }
  }
  return image;
}

/// As the toolkit's calc_2d_bbox has it: largest minus smallest.
Json toolkit_box(const PixelRect& box) { return {box.x, box.y, box.width - 1, box.height - 1}; }

class Bop : public ExportFormat {
 public:
  Bop(const Dataset& dataset, const ExportOptions& options)
      : dataset_(dataset), options_(options), ids_(bop_object_ids(dataset.assets)) {}

  FrameParts needs() const override {
    return {.image_file = dataset_.has_images, .depth = dataset_.has_depth};
  }

  std::vector<DocumentKind> documents() const override {
    Json categories = Json::array();
    for (const auto& [name, id] : ids_) {
      categories.push_back({{"id", id}, {"name", name}, {"supercategory", "object"}});
    }
    const auto object = [](const char* path) {
      return DocumentKind{.path = path,
                          .scope = DocumentKind::Scope::kScene,
                          .header = "{\n",
                          .breaks = {},
                          .footer = "\n}\n",
                          .separator = ",\n"};
    };
    return {object("{split}/{scene}/scene_camera.json"),
            object("{split}/{scene}/scene_gt.json"),
            object("{split}/{scene}/scene_gt_info.json"),
            coco_document("{split}/{scene}/scene_gt_coco.json", DocumentKind::Scope::kScene,
                          dataset_, categories),
            {.path = "{split}_targets_bop19.json",
             .scope = DocumentKind::Scope::kSplit,
             .header = "[\n",
             .breaks = {},
             .footer = "\n]\n",
             .separator = ",\n"}};
  }

  std::vector<std::filesystem::path> folders() const override {
    std::vector<std::filesystem::path> folders;
    for (const SplitShare& split : options_.splits) folders.emplace_back(split.name);
    return folders;
  }

  Result<FrameRecord> encode(const ExportFrame& frame) const override {
    FrameRecord record;
    record.counts = count_instances(frame);
    const std::string scene = scene_path(frame);
    ScaledDepth depth;
    if (frame.loaded.depth) {
      depth = scaled_depth(*frame.loaded.depth);
      record.files.push_back({scene + "depth/" + frame.stem + ".png", encode_png(depth.units)});
    }
    if (dataset_.has_images) {
      record.placed.push_back(image_at(scene + "rgb/" + image_name(frame), frame));
    }
    const auto wholes = silhouettes(frame);
    if (!wholes) return forward_error(wholes);
    auto entries = entries_of(frame, *wholes, depth);
    if (!entries) return forward_error(entries);
    for (std::size_t i = 0; i < frame.instances.size(); ++i) {
      const Mask& whole = (*wholes)[i].mask;
      record.files.push_back({mask_path(frame, i, "mask/"), encode_png(mask_image(whole))});
      record.files.push_back({mask_path(frame, i, "mask_visib/"),
                              encode_png(mask_image(visible(frame, frame.instances[i])))});
    }
    record.chunks = std::move(*entries);
    return record;
  }

  Result<CommonPart> common_part(const ExportSummary&) const override {
    CommonPart common;
    if (!dataset_.has_depth) {
      common.warnings.emplace_back(
          "the campaign has no depth (render: {passes: [depth]}): bop was written without it");
    }
    const auto camera = camera_of_first_frame();
    if (!camera) return forward_error(camera);
    common.files["camera.json"] = readable_json(*camera);
    add_bop_models(dataset_.assets, common);
    return common;
  }

  std::vector<std::string> differences(const ExportFrame& frame,
                                       const WrittenFrame& written) const override {
    std::vector<std::string> found;
    ScaledDepth depth;
    if (frame.loaded.depth) {
      depth = scaled_depth(*frame.loaded.depth);
      const std::string path = scene_path(frame) + "depth/" + frame.stem + ".png";
      const auto png = decode_png16(written.file(path), path);
      if (!png || png->values != depth.units.values) found.push_back(path + " is another depth");
    }
    const auto wholes = silhouettes(frame);
    if (!wholes) return {wholes.error().message};
    const auto entries = entries_of(frame, *wholes, depth);
    if (!entries) return {entries.error().message};
    bool same = entries->size() == written.chunks.size();
    for (std::size_t i = 0; same && i < entries->size(); ++i) {
      same = (*entries)[i].text == written.chunks[i].text;
    }
    if (!same) found.emplace_back("its entries in scene_*.json are others");
    for (std::size_t i = 0; i < frame.instances.size(); ++i) {
      for (const auto& [path, mask] :
           {std::pair(mask_path(frame, i, "mask/"), (*wholes)[i].mask),
            std::pair(mask_path(frame, i, "mask_visib/"), visible(frame, frame.instances[i]))}) {
        const auto png = decode_png8(written.file(path), path);
        if (!png || png->values != mask_image(mask).values) {
          found.push_back(path + " is another mask");
        }
      }
    }
    return found;
  }

 private:
  static std::string scene_path(const ExportFrame& frame) {
    return fmt::format("{}/{:06}/", frame.split, frame.frame.scene);
  }
  static std::string mask_path(const ExportFrame& frame, std::size_t index, const char* folder) {
    return fmt::format("{}{}{}_{:06}.png", scene_path(frame), folder, frame.stem, index);
  }
  static Mask visible(const ExportFrame& frame, const ExportInstance& instance) {
    return {frame.loaded.instance_ids, instance.label->id, instance.label->box};
  }

  /// Of the exported instances, in their order.
  static Result<std::vector<ExportInstance>> silhouettes(const ExportFrame& frame) {
    std::vector<ExportInstance> wholes;
    for (const ExportInstance& instance : frame.instances) {
      auto whole = whole_instance(frame.frame, frame.loaded, *instance.label);
      if (!whole) return forward_error(whole);
      wholes.push_back(std::move(*whole));
    }
    return wholes;
  }

  Result<int> object_id(const ExportFrame& frame, const InstanceLabel& label) const {
    const auto found = ids_.find(label.asset);
    if (found != ids_.end()) return found->second;
    return fail(ErrorKind::kCorrupt,
                "frame {}, instance {} ('{}') is of the asset '{}', which the campaign's config no "
                "longer uses: put it back, or submit the campaign again",
                frame.frame.index, label.id, label.name, label.asset);
  }

  static Status check_rigid(const ExportFrame& frame, const InstanceLabel& label) {
    constexpr double kRounding = 1e-6;
    if (!label.amodal) {
      return fail(ErrorKind::kInput, "frame {}: its labels have no poses", frame.frame.index);
    }
    const Eigen::Vector3d& scale = label.amodal->pose.scale;
    if ((scale.array() - 1.0).abs().maxCoeff() <= kRounding) return {};
    return fail(ErrorKind::kInput,
                "frame {}, instance {} ('{}') is scaled by {:.4g}, {:.4g}, {:.4g}, and BOP's poses "
                "are rigid: import the asset at its size and leave out 'scale', or export to "
                "another format",
                frame.frame.index, label.id, label.name, scale.x(), scale.y(), scale.z());
  }

  /// All entries of the frame in the documents; `depth` has no units when there is none.
  Result<std::vector<Chunk>> entries_of(const ExportFrame& frame,
                                        const std::vector<ExportInstance>& wholes,
                                        const ScaledDepth& depth) const {
    Json poses = Json::array();
    Json infos = Json::array();
    std::map<int, int> counts;
    std::vector<Chunk> annotations;
    for (const ExportInstance& whole : wholes) {
      const InstanceLabel& label = *whole.label;
      if (Status rigid = check_rigid(frame, label); !rigid) return forward_error(rigid);
      const auto id = object_id(frame, label);
      if (!id) return forward_error(id);
      if (is_target(label)) ++counts[*id];
      const Pose& pose = label.amodal->pose;
      const Eigen::Vector3d t = opencv_axes() * pose.translation_m * kMillimetresPerMetre;
      poses.push_back({{"cam_R_m2c", matrix_json(opencv_axes() * pose.rotation)},
                       {"cam_t_m2c", {t.x(), t.y(), t.z()}},
                       {"obj_id", *id}});
      infos.push_back(info_json(whole, depth));
      annotations.push_back({kCoco, kCocoAnnotations, coco_text(frame, whole, *id)});
    }
    const std::string key = fmt::format("\"{}\":", frame.frame.index);
    std::vector<Chunk> chunks = {{kCamera, 0, key + canonical_json(camera_json(frame, depth))},
                                 {kGroundTruth, 0, key + canonical_json(poses)},
                                 {kInfo, 0, key + canonical_json(infos)},
                                 {kCoco, kCocoImages, coco_image_text(frame)}};
    std::move(annotations.begin(), annotations.end(), std::back_inserter(chunks));
    for (const auto& [id, count] : counts) {
      chunks.push_back({kTargets, 0,
                        canonical_json({{"im_id", frame.frame.index},
                                        {"inst_count", count},
                                        {"obj_id", id},
                                        {"scene_id", frame.frame.scene}})});
    }
    return chunks;
  }

  /// As the toolkit chooses what is to be found, and what is ignored.
  static bool is_target(const InstanceLabel& label) {
    constexpr double kLeastVisible = 0.1;
    return label.visible_fraction() >= kLeastVisible;
  }

  /// Each image has its own in scene_camera.json; this one is for readers that know a single
  /// sensor.
  Result<Json> camera_of_first_frame() const {
    const auto frame = dataset_.frames()();
    if (!frame) return forward_error(frame);
    if (!*frame) return fail(ErrorKind::kInput, "bop's camera.json needs a frame, there is none");
    const auto files = FrameReader::open(**frame, {.depth = dataset_.has_depth});
    if (!files) return forward_error(files);
    const auto loaded = files->load(dataset_.categories);
    if (!loaded) return forward_error(loaded);
    const FrameLabels& labels = loaded->labels;
    Json camera = {{"width", labels.width},     {"height", labels.height},
                   {"fx", labels.focal_px[0]},  {"fy", labels.focal_px[1]},
                   {"cx", labels.center_px[0]}, {"cy", labels.center_px[1]}};
    if (loaded->depth) camera["depth_scale"] = scaled_depth(*loaded->depth).scale_mm;
    return camera;
  }

  static Json camera_json(const ExportFrame& frame, const ScaledDepth& depth) {
    const FrameLabels& labels = frame.loaded.labels;
    return {{"cam_K",
             {labels.focal_px[0], 0, labels.center_px[0], 0, labels.focal_px[1],
              labels.center_px[1], 0, 0, 1}},
            {"depth_scale", depth.scale_mm}};
  }

  static Json info_json(const ExportInstance& whole, const ScaledDepth& depth) {
    const InstanceLabel& label = *whole.label;
    std::int64_t valid = 0;
    if (!depth.units.values.empty()) {
      const PixelRect& box = whole.box();
      for (int row = box.y; row < box.end_y(); ++row) {
        for (int column = box.x; column < box.end_x(); ++column) {
          valid += whole.mask.at(row, column) && depth.units.at(row, column) != 0;
        }
      }
    }
    return {{"bbox_obj", toolkit_box(label.amodal->box)},
            {"bbox_visib", toolkit_box(label.box)},
            {"px_count_all", label.amodal->area_px},
            {"px_count_valid", valid},
            {"px_count_visib", label.area_px},
            {"visib_fract", label.visible_fraction()}};
  }

  static std::string coco_image_text(const ExportFrame& frame) {
    const FrameLabels& labels = frame.loaded.labels;
    return canonical_json({{"file_name", "rgb/" + image_name(frame)},
                           {"height", labels.height},
                           {"id", frame.frame.index},
                           {"width", labels.width}});
  }

  /// The visible mask, and the box of the silhouette: what the toolkit makes unless told otherwise.
  static std::string coco_text(const ExportFrame& frame, const ExportInstance& whole, int object) {
    const InstanceLabel& label = *whole.label;
    const PixelRect& box = whole.box();
    const Mask mask(frame.loaded.instance_ids, label.id, label.box);
    return fmt::format(
        R"({{"area":{},"bbox":[{},{},{},{}],"category_id":{},"height":{},"id":{},"ignore":{},"image_id":{},"iscrowd":0,"segmentation":{},"width":{}}})",
        label.area_px, box.x, box.y, box.width, box.height, object, mask.image_height(),
        coco_annotation_id(frame.frame.index, label.id), !is_target(label), frame.frame.index,
        coco_rle(mask), mask.image_width());
  }

  const Dataset& dataset_;
  const ExportOptions& options_;
  std::map<std::string, int> ids_;  ///< of assets by name
};

}  // namespace

Result<std::unique_ptr<ExportFormat>> make_bop(const Dataset& dataset,
                                               const ExportOptions& options) {
  const bool readable =
      dataset.image_format == ImageFormat::kPng || dataset.image_format == ImageFormat::kJpeg;
  if (dataset.has_images && !readable) {
    return fail(ErrorKind::kInput,
                "BOP's tools look for images that end in .png or .jpg, and those of campaign '{}' "
                "are {}: submit it with 'image.format=png' or 'jpeg', or export to another format",
                dataset.name, name_of(dataset.image_format));
  }
  return std::make_unique<Bop>(dataset, options);
}

}  // namespace seedframe
