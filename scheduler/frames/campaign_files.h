// Every file and folder name of a campaign, built and parsed in one place
// (docs/formats/campaign.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "spec/image_encoding.h"

namespace seedframe {

/// The folder of one campaign. Frames are numbered from 0 over the whole campaign.
class CampaignFiles {
 public:
  explicit CampaignFiles(std::filesystem::path root) : root_(std::move(root)) {}

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path config() const { return root_ / "campaign.yaml"; }
  /// The values of a campaign whose frames were asked for one by one: one line a frame.
  std::filesystem::path graphs() const { return root_ / "graphs.jsonl"; }
  std::filesystem::path provenance() const { return root_ / "provenance.json"; }
  std::filesystem::path store() const { return root_ / "campaign.sqlite"; }
  /// The store until every frame is in it: without its final name there is no campaign.
  std::filesystem::path unfinished_store() const { return root_ / "campaign.sqlite.new"; }
  std::filesystem::path lock() const { return root_ / "campaign.lock"; }
  std::filesystem::path frames() const { return root_ / "frames"; }
  std::filesystem::path logs() const { return root_ / "logs"; }
  std::filesystem::path worker_log(int worker) const;
  /// The last words of a worker that a frame has cost.
  std::filesystem::path crash_log(std::int64_t frame, int attempt) const;
  /// What runs print that `seedframe serve` has started.
  std::filesystem::path serve_log() const { return logs() / "serve.log"; }
  std::filesystem::path exports() const { return root_ / "exports"; }
  /// What exports need of the config, and of an asset.
  std::filesystem::path kept_inputs() const { return root_ / "inputs" / "inputs.json"; }
  std::filesystem::path kept_asset(const std::string& name) const {
    return root_ / "inputs" / "assets" / name;
  }
  /// The page that `seedframe report` makes; beside it, for many frames, report_files/.
  std::filesystem::path report() const { return root_ / "report.html"; }
  /// What a run by Slurm and its tasks tell each other (slurm/submission.h), a folder for each
  /// submission, and what the tasks print. Gone when nothing runs and nothing was lost.
  std::filesystem::path slurm() const { return root_ / "slurm"; }
  std::filesystem::path slurm_logs() const { return slurm() / "logs"; }
  /// How far that is: written by the head, read by `seedframe status`.
  std::filesystem::path slurm_state() const { return slurm() / "state.json"; }
  /// The names of the nodes that have made frames; kNodeWorkers of workers are each one's.
  std::filesystem::path nodes() const { return root_ / "nodes.json"; }
  /// What was rendered of a frame that is not as its twin sees it, for inspection.
  std::filesystem::path rejected(std::int64_t frame) const;
  /// Scratch space: mesh buffers for the workers and attempts under way. Gone when nothing runs.
  std::filesystem::path work() const { return root_ / "work"; }
  std::filesystem::path disk_probe() const { return work() / "probe"; }
  std::filesystem::path meshes() const { return work() / "meshes"; }
  /// A frame in the making, where no worker gets.
  std::filesystem::path attempt(std::int64_t frame, int attempt) const;
  /// All that workers may write to: their temporary files, and a folder for each attempt.
  std::filesystem::path workers() const { return work() / "workers"; }
  static std::string attempt_name(std::int64_t frame, int attempt);

  /// frames/<thousands>/<index>, for example frames/012/012345.
  std::filesystem::path frame(std::int64_t frame) const;

  /// All that may lie in the root, the store first.
  std::vector<std::filesystem::path> own() const;

 private:
  std::filesystem::path root_;
};

/// Names inside the folder of one frame.
namespace frame_files {
inline constexpr const char* kSpec = "frame.json";
inline constexpr const char* kPasses = "passes.exr";
inline constexpr const char* kInstances = "instances.png";
inline constexpr const char* kSemantic = "semantic.png";
inline constexpr const char* kDepth = "depth.exr";
inline constexpr const char* kNormal = "normal.exr";
inline constexpr const char* kLabels = "labels.json";
inline constexpr const char* kManifest = "manifest.json";
// Of a rejected frame only:
inline constexpr const char* kTwin = "twin.png";              ///< ids as in instances.png
inline constexpr const char* kDifference = "difference.png";  ///< see difference_image
inline constexpr const char* kReason = "reason.txt";
/// The picture: "image.png", "image.jpg", "image.webp" or "image.tif".
std::string image(ImageFormat format);
}  // namespace frame_files

/// The stem that a frame has in every export: "000042".
std::string frame_stem(std::int64_t frame);

}  // namespace seedframe
