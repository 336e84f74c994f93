#include "image/color_tables.h"

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
    try {
      status_ = allowed_.check(context_->resolveFileLocation(table),
                               fmt::format("its table '{}'", table));
    } catch (const OCIO::ExceptionMissingFile&) {
      // OpenColorIO will not find it either, and says so if a view needs it.
    }
  }

  OCIO::ConstContextRcPtr context_;
  AllowedFolders allowed_;
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
