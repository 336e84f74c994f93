// The files of a committed frame, read and compared with their manifest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "annotate/labels.h"
#include "base/error.h"
#include "frames/manifest.h"
#include "image/image.h"
#include "spec/frame_spec.h"

namespace seedframe {

struct CommittedFrame {
  std::int64_t index = 0;  ///< over the whole campaign
  int scene = 0;
  std::filesystem::path folder;  ///< holds what campaign_files.h names
  std::string frame_id;
};

/// What frame.json in a frame's folder says, whatever its manifest does.
Result<FrameSpec> stored_spec(const std::filesystem::path& folder);

/// Which files of a frame are needed beside its labels.
struct FrameParts {
  bool image_file = false;    ///< the picture, as it is
  bool image_pixels = false;  ///< the same, decoded
  bool depth = false;
  bool normal = false;  ///< if the frame has them
};

struct LoadedFrame {
  FrameLabels labels;
  Image<std::uint16_t> instance_ids;
  std::optional<Image<std::uint8_t>> image;  ///< RGB
  std::optional<Image<float>> depth;         ///< planar, metres
  std::string image_file = "image.png";      ///< of the picture, in the frame's folder
  std::string image_sha256 = {};             ///< of that file
  std::optional<Image<float>> normal = {};   ///< x, y, z in the camera's frame
};

/// The files of a frame, found to be those of its manifest.
class FrameReader {
 public:
  /// kCorrupt errors name the frame and the file that is missing or not as it was written.
  static Result<FrameReader> open(const CommittedFrame& frame, const FrameParts& parts);

  /// Changes whenever any file of the frame does, its id or its scene.
  const std::string& key() const { return key_; }
  /// Name of the picture's file.
  std::string image_file() const { return manifest_.image_file(); }
  std::filesystem::path path(const std::string& name) const { return frame_.folder / name; }
  /// As the manifest has it; empty for a file that the frame does not have.
  std::string sha256(const std::string& name) const;

  /// Decodes, and compares labels and pixels. kCorrupt errors name the frame, and the instance:
  /// another area or box than the pixels have, an id that only one of the files knows, other
  /// categories than those that are expected.
  Result<LoadedFrame> load(const std::vector<std::string>& categories) const;

 private:
  FrameReader() = default;

  CommittedFrame frame_;
  FrameParts parts_;
  Manifest manifest_;
  std::string key_;
  std::string labels_;
  std::string instances_;
};

}  // namespace seedframe
