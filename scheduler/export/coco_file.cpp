#include "export/coco_file.h"

namespace seedframe {
namespace {

std::filesystem::path part_path_of(std::filesystem::path path) { return path += ".annotations"; }

void add_entry(std::ofstream& stream, const Json& entry, bool& has_entry) {
  stream << (has_entry ? ",\n" : "\n") << canonical_json(entry);
  has_entry = true;
}

}  // namespace

CocoFile::CocoFile(std::filesystem::path path, const std::string& description,
                   const std::vector<std::string>& categories)
    : path_(std::move(path)),
      part_path_(part_path_of(path_)),
      file_(path_, std::ios::binary),
      part_(part_path_, std::ios::binary) {
  const Json info = {{"description", description}, {"version", "1"}};
  file_ << "{\n\"info\":" << canonical_json(info) << ",\n\"licenses\":[],\n\"categories\":[";
  bool has_category = false;
  for (std::size_t i = 0; i < categories.size(); ++i) {
    add_entry(file_, {{"id", i + 1}, {"name", categories[i]}, {"supercategory", "object"}},
              has_category);
  }
  file_ << "\n],\n\"images\":[";
}

void CocoFile::add_image(const Json& image) { add_entry(file_, image, has_image_); }

void CocoFile::add_annotation(const Json& annotation) {
  add_entry(part_, annotation, has_annotation_);
}

Status CocoFile::finish() {
  part_.close();
  file_ << "\n],\n\"annotations\":[";
  if (has_annotation_) {
    const std::ifstream annotations(part_path_, std::ios::binary);
    file_ << annotations.rdbuf();
  }
  file_ << "\n]\n}\n";
  file_.close();
  std::error_code error;
  std::filesystem::remove(part_path_, error);
  if (!part_ || !file_ || error) {
    return fail(ErrorKind::kEnvironment, "cannot write {}: is the disk full?", path_.string());
  }
  return {};
}

}  // namespace seedframe
