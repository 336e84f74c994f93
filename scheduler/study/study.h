// What changes Cycles' pixels, measured: scenes × conditions, each compared with a reference.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "image/color_management.h"
#include "image/difference.h"
#include "image/pass_reader.h"
#include "render/blender_info.h"
#include "render/worker_conditions.h"

namespace seedframe {

/// How a Blender is started, and what it renders in which way.
struct StudySetting {
  int threads = 1;
  int samples = 16;
  bool adaptive = false;         ///< adaptive sampling
  bool persistent_data = false;  ///< from frame to frame
  bool after_frames = false;     ///< two frames of the scene are rendered before
  bool reversed = false;         ///< the last scene first
  bool one_cpu = true;           ///< Blender is started on one CPU, as Seedframe starts its workers
  std::optional<Kernels> kernels;
};

/// What is compared: `setting` with `reference`, which differs from it in what `name` says.
struct StudyCondition {
  std::string name;
  StudySetting setting;
  StudySetting reference;
  int repetitions = 1;  ///< of the setting; the worst counts
};

/// How far apart two renderings of one scene are.
struct StudyCell {
  ImageDifference linear;                                           ///< combined pass, scene-linear
  ImageDifference display;                                          ///< 8 bits, Standard view
  std::int64_t other_ids = 0, other_depths = 0, other_normals = 0;  ///< pixels
};

/// Pixels of all scenes by how dark the reference is: bins of 64 of its 8-bit luma.
struct DarknessBin {
  std::int64_t pixels = 0, differing_linear = 0, differing_display = 0;
  double sum_absolute = 0.0;  ///< of differences of luma, scene-linear
  double sum_relative = 0.0;  ///< of these over the luma
};
using Darkness = std::array<DarknessBin, 4>;

struct StudyRow {
  StudyCondition condition;
  std::vector<StudyCell> cells;  ///< in the order of study_scenes()
  Darkness darkness;
};

/// Of blender_scripts/study/study_scenes.py.
const std::vector<std::string>& study_scenes();
/// Everything but the numbers of samples, at 16 samples.
std::vector<StudyCondition> study_conditions();
/// Threads, and kernels of an older CPU, at 1 to `most` samples, in steps of four.
std::vector<StudyCondition> sample_conditions(int most);

class Study {
 public:
  struct Tools {
    BlenderInfo blender;
    std::filesystem::path scripts;  ///< blender_scripts/
    std::filesystem::path preload;  ///< see environment_of
    std::filesystem::path scratch;  ///< a folder for what is rendered
    int width = 160, height = 120;
  };
  /// The colours must outlive it.
  Study(Tools tools, const ColorManagement& color) : tools_(std::move(tools)), color_(color) {}

  /// A setting that several conditions need is rendered once. kEnvironment errors: Blender failed.
  Result<StudyRow> measure(const StudyCondition& condition);
  /// "Blender 3.4.1, Cycles' kernel avx2, Embree's avx512, 2 CPUs", of the last rendering, and how
  /// often it crashed and was started again.
  Result<std::string> made_with() const;

 private:
  struct Picture {
    FramePasses passes;
    Image<std::uint8_t> display;
  };
  using Pictures = std::vector<Picture>;  ///< by scene
  Result<Pictures> render(const StudySetting& setting);
  Result<const Pictures*> reference(const StudySetting& setting);

  Tools tools_;
  const ColorManagement& color_;
  int crashes_ = 0;
  std::map<std::string, Pictures> references_;  ///< by what describes a setting
};

}  // namespace seedframe
