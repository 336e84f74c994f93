// A frame while it is being expanded: its spec, and where things are in the world.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "assets/asset_library.h"
#include "assets/used_files.h"
#include "draws/number_draw.h"
#include "spec/frame_spec.h"

namespace seedframe {

inline constexpr int kLargestInstanceId = 32767;  // Blender's limit of pass_index

/// Something in the world, before the camera is known.
struct PlacedInstance {
  InstanceSpec spec;
  Affine world_from_object = Affine::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of its bounding box, world
  std::size_t section = 0;                           ///< of the config's objects
  std::shared_ptr<const Asset> asset;                ///< none: the ground
  std::shared_ptr<const std::string> buffer;         ///< of its mesh
  bool auto_detail = false;                          ///< may take a coarser level of the asset
};

struct FrameDraft {
  FrameSpec spec;
  Affine world_from_camera = Affine::Identity();
  std::vector<PlacedInstance> placed;
  int objects = 0;                      ///< placed, without the ground
  double ground_curvature_per_m = 0.0;  ///< z = curvature · (x² + y²) / 2
  /// For each section how many copies there are so far, and where the first one is (without its
  /// scale).
  struct Section {
    std::uint32_t copies = 0;
    Affine world_from_first = Affine::Identity();
  };
  std::vector<Section> sections;
  UsedFiles used;  ///< also by earlier attempts at the frame
};

/// A value with its bounds; what is outside is reported, and something inside returned.
double at_least(const NumberDraw& draw, double least, bool open, const char* what,
                EvaluationContext& context);
double positive(const NumberDraw& draw, const char* what, EvaluationContext& context);
double not_negative(const NumberDraw& draw, const char* what, EvaluationContext& context);
double within(const NumberDraw& draw, double least, double most, const char* what,
              EvaluationContext& context);
/// A count, rounded to a whole number.
std::uint32_t copies_of(const NumberDraw& count, std::uint32_t most, EvaluationContext& context);

}  // namespace seedframe
