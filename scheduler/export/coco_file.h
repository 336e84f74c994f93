// One COCO JSON file, written as a stream.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"

namespace seedframe {

/// COCO keeps images and annotations in two arrays. Images go straight to the file, annotations to
/// a part file beside it, which finish() appends and removes. One entry a line.
class CocoFile {
 public:
  /// `path` + ".annotations" is the part file.
  CocoFile(std::filesystem::path path, const std::string& description,
           const std::vector<std::string>& categories);

  void add_image(const Json& image);
  void add_annotation(const Json& annotation);
  /// Must be called last; reports any write that failed since the file was opened.
  Status finish();

 private:
  std::filesystem::path path_;
  std::filesystem::path part_path_;
  std::ofstream file_;
  std::ofstream part_;
  bool has_image_ = false;
  bool has_annotation_ = false;
};

}  // namespace seedframe
