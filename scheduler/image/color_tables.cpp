#include "image/color_tables.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <pugixml.hpp>

#include "base/allowed_folders.h"

namespace seedframe {
namespace OCIO = OCIO_NAMESPACE;
namespace {

class TableCheck {
 public:
  TableCheck(const OCIO::Config& config, const std::filesystem::path& folder)
      : context_(config.getCurrentContext()), allowed_({folder}) {}

  void look_at(const OCIO::ConstTransformRcPtr& transform) {
    if (!transform || !status_) return;
    if (const auto group = OCIO_DYNAMIC_POINTER_CAST<const OCIO::GroupTransform>(transform)) {
      for (int i = 0; i < group->getNumTransforms(); ++i) look_at(group->getTransform(i));
    } else if (const auto file = OCIO_DYNAMIC_POINTER_CAST<const OCIO::FileTransform>(transform)) {
      look_at(file->getSrc());
    }
  }

  const Status& status() const { return status_; }

 private:
  void look_at(const char* table) {
    std::string path;
    try {
      path = context_->resolveFileLocation(table);
    } catch (const OCIO::ExceptionMissingFile&) {
      return;  // OpenColorIO will not find it either, and says so if a view needs it
    }
    status_ = allowed_.check(path, fmt::format("its table '{}'", table));
    if (status_) look_into(path);
  }

  /// Tables that are XML (CTF, CLF) may refer to further ones.
  void look_into(const std::string& path) {
    if (std::find(open_.begin(), open_.end(), path) != open_.end()) {
      status_ = fail(ErrorKind::kInput, "its table '{}' refers to itself", path);
      return;
    }
    if (!seen_.insert(path).second || !begins_as_xml(path)) return;
    pugi::xml_document document;
    if (!document.load_file(path.c_str())) return;  // no XML after all
    open_.push_back(path);
    for (const pugi::xpath_node& found :
         document.select_nodes("//*[translate(local-name(),'REFNC','refnc')='reference']/@path")) {
      if (status_) look_at(found.attribute().value());
    }
    open_.pop_back();
  }

  static bool begins_as_xml(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string beginning(256, '\0');
    file.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    const std::size_t first = beginning.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return first != std::string::npos && beginning[first] == '<';
  }

  OCIO::ConstContextRcPtr context_;
  AllowedFolders allowed_;
  std::set<std::string> seen_;
  std::vector<std::string> open_;  ///< tables, each referred to by the one before it
  Status status_;
};

}  // namespace

Status check_color_tables(const OCIO::Config& config, const std::filesystem::path& folder) {
  TableCheck check(config, folder);
  const auto all = OCIO::SEARCH_REFERENCE_SPACE_ALL;
  for (int i = 0; i < config.getNumColorSpaces(all, OCIO::COLORSPACE_ALL); ++i) {
    const char* name = config.getColorSpaceNameByIndex(all, OCIO::COLORSPACE_ALL, i);
    const auto space = config.getColorSpace(name);
    if (!space) continue;
    check.look_at(space->getTransform(OCIO::COLORSPACE_DIR_TO_REFERENCE));
    check.look_at(space->getTransform(OCIO::COLORSPACE_DIR_FROM_REFERENCE));
  }
  for (int i = 0; i < config.getNumLooks(); ++i) {
    const auto look = config.getLook(config.getLookNameByIndex(i));
    if (!look) continue;
    check.look_at(look->getTransform());
    check.look_at(look->getInverseTransform());
  }
  for (int i = 0; i < config.getNumViewTransforms(); ++i) {
    const auto view = config.getViewTransform(config.getViewTransformNameByIndex(i));
    if (!view) continue;
    check.look_at(view->getTransform(OCIO::VIEWTRANSFORM_DIR_TO_REFERENCE));
    check.look_at(view->getTransform(OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE));
  }
  for (int i = 0; i < config.getNumNamedTransforms(); ++i) {
    const auto named = config.getNamedTransform(config.getNamedTransformNameByIndex(i));
    if (!named) continue;
    check.look_at(named->getTransform(OCIO::TRANSFORM_DIR_FORWARD));
    check.look_at(named->getTransform(OCIO::TRANSFORM_DIR_INVERSE));
  }
  return check.status();
}

}  // namespace seedframe
