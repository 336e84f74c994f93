#include "image/color_management.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <tuple>
#include <utility>

#include <OpenColorIO/OpenColorIO.h>

#include "base/files.h"
#include "base/nearest_name.h"
#include "base/portable_math.h"
#include "base/sha256.h"
#include "image/color_config_level.h"
#include "image/color_tables.h"

namespace seedframe {
namespace OCIO = OCIO_NAMESPACE;
namespace {

constexpr int kRgb = 3;
constexpr int kRgba = 4;

bool has_look(const ImageSettings& settings) {
  return !settings.look.empty() && settings.look != "None";
}

/// What settings may name. Read once, by one thread: OpenColorIO 2.1 fills such lists when they are
/// first asked for, and without a lock.
struct Names {
  std::vector<std::string> displays;
  std::map<std::string, std::vector<std::string>> views;  ///< by display
  std::vector<std::string> looks = {"None"};
  std::set<std::string> left_out;  ///< views that need a later OpenColorIO
};

Names read_names(const OCIO::Config& config) {
  Names names;
  for (int i = 0; i < config.getNumDisplays(); ++i) {
    const char* display = config.getDisplay(i);
    names.displays.emplace_back(display);
    std::vector<std::string>& views = names.views[display];
    for (int j = 0; j < config.getNumViews(display); ++j) {
      views.emplace_back(config.getView(display, j));
    }
  }
  for (int i = 0; i < config.getNumLooks(); ++i) {
    names.looks.emplace_back(config.getLookNameByIndex(i));
  }
  return names;
}

Status check_name(const char* kind, const std::string& name,
                  const std::vector<std::string>& candidates) {
  if (std::find(candidates.begin(), candidates.end(), name) != candidates.end()) return {};
  return fail(ErrorKind::kInput, "the OCIO config has no {} '{}'{}", kind, name,
              did_you_mean(name, candidates));
}

/// The look goes from scene-linear to its own space; the view then starts from there.
OCIO::ConstCPUProcessorRcPtr look_and_view(const OCIO::ConstConfigRcPtr& config,
                                           const ImageSettings& settings) {
  auto group = OCIO::GroupTransform::Create();
  std::string space = OCIO::ROLE_SCENE_LINEAR;
  if (has_look(settings)) {
    const std::string look_space = OCIO::LookTransform::GetLooksResultColorSpace(
        config, config->getCurrentContext(), settings.look.c_str());
    auto look = OCIO::LookTransform::Create();
    look->setSrc(space.c_str());
    look->setDst(look_space.c_str());
    look->setLooks(settings.look.c_str());
    group->appendTransform(look);
    space = look_space;
  }
  auto view = OCIO::DisplayViewTransform::Create();
  view->setSrc(space.c_str());
  view->setDisplay(settings.display.c_str());
  view->setView(settings.view.c_str());
  // A look that the view prescribes gives way to the one that was asked for.
  view->setLooksBypass(has_look(settings));
  group->appendTransform(view);
  return config->getProcessor(group)->getDefaultCPUProcessor();
}

OCIO::ConstCPUProcessorRcPtr display_gamma(const OCIO::ConstConfigRcPtr& config, double gamma) {
  const double power = 1.0 / gamma;
  const double exponents[4] = {power, power, power, 1.0};
  auto transform = OCIO::ExponentTransform::Create();
  transform->setValue(exponents);
  return config->getProcessor(transform)->getDefaultCPUProcessor();
}

std::uint8_t code_value(float display) {
  // NaN fails the first comparison and becomes black.
  if (!(display > 0.0F)) return 0;
  // As Blender rounds; lround would call a function for every value.
  // NOLINTNEXTLINE(bugprone-incorrect-roundings)
  return display >= 1.0F ? 255 : static_cast<std::uint8_t>(display * 255.0F + 0.5F);
}

}  // namespace

struct ColorManagement::State {
  using Key = std::tuple<std::string, std::string, std::string>;

  std::string path;
  std::string hash;
  Names names;
  std::mutex mutex;  ///< for what follows
  OCIO::ConstConfigRcPtr config;
  std::map<Key, OCIO::ConstCPUProcessorRcPtr> processors;

  /// Only the tables of look and view are worth keeping (tens of ms). Exposure and gamma may differ
  /// in every frame, so they stay out of the cache: it cannot outgrow the names in the config.
  OCIO::ConstCPUProcessorRcPtr view_processor(const ImageSettings& settings) {
    const Key key{settings.display, settings.view, has_look(settings) ? settings.look : ""};
    const std::lock_guard lock(mutex);
    OCIO::ConstCPUProcessorRcPtr& cached = processors[key];
    if (!cached) cached = look_and_view(config, settings);
    return cached;
  }

  /// Null for a gamma of 1.
  OCIO::ConstCPUProcessorRcPtr gamma_processor(double gamma) {
    if (gamma == 1.0) return nullptr;
    const std::lock_guard lock(mutex);
    return display_gamma(config, gamma);
  }
};

ColorManagement::ColorManagement(std::unique_ptr<State> state) : state_(std::move(state)) {}
ColorManagement::~ColorManagement() = default;
ColorManagement::ColorManagement(ColorManagement&&) noexcept = default;
ColorManagement& ColorManagement::operator=(ColorManagement&&) noexcept = default;

Result<ColorManagement> ColorManagement::load(const std::filesystem::path& ocio_config) {
  const Result<std::string> text = read_file(ocio_config);
  if (!text)
    return fail(ErrorKind::kInput, "cannot read the OCIO config: {}", text.error().message);
  auto state = std::make_unique<State>();
  state->hash = sha256_hex(*text);
  state->path = ocio_config.string();
  try {
    auto [config, left_out] = read_color_config(*text, ocio_config.parent_path());
    // OpenColorIO would keep every processor that it ever made, one for each gamma.
    config->setProcessorCacheFlags(OCIO::PROCESSOR_CACHE_OFF);
    const Status own_tables = check_color_tables(*config, ocio_config.parent_path());
    if (!own_tables) {
      return fail(ErrorKind::kInput, "{}: {}", ocio_config.string(), own_tables.error().message);
    }
    config->validate();
    state->names = read_names(*config);
    state->names.left_out = std::move(left_out);
    state->config = config;
  } catch (const std::exception& exception) {
    return fail(ErrorKind::kInput, "{} is not an OCIO config that OpenColorIO {} can read: {}",
                ocio_config.string(), OCIO::GetVersion(), exception.what());
  }
  return ColorManagement(std::move(state));
}

Status ColorManagement::check(const ImageSettings& settings) const {
  const Names& names = state_->names;
  if (Status known = check_name("display", settings.display, names.displays); !known) return known;
  const std::vector<std::string>& views = names.views.at(settings.display);
  if (names.left_out.count(settings.view) > 0) {
    return fail(
        ErrorKind::kInput,
        "the view '{}' of the OCIO config needs a later OpenColorIO than {}, which is here; "
        "choose another one",
        settings.view, OCIO::GetVersion());
  }
  if (Status known = check_name("view", settings.view, views); !known) return known;
  if (has_look(settings)) {
    if (Status known = check_name("look", settings.look, names.looks); !known) return known;
  }
  if (!std::isfinite(settings.exposure_stops)) {
    return fail(ErrorKind::kInput, "the exposure must be a finite number of stops, not {}",
                settings.exposure_stops);
  }
  if (!(std::isfinite(settings.gamma) && settings.gamma > 0.0)) {
    return fail(ErrorKind::kInput, "the gamma must be a number above 0, not {}", settings.gamma);
  }
  return {};
}

Result<Image<std::uint8_t>> ColorManagement::apply(const Image<float>& combined,
                                                   const ImageSettings& settings) const {
  assert(combined.channels == kRgba);
  if (Status checked = check(settings); !checked) return forward_error(checked);
  Image<std::uint8_t> picture(combined.width, combined.height, kRgb);
  const auto row_values = static_cast<std::size_t>(combined.width) * kRgba;
  const auto scale = static_cast<float>(portable::pow(2.0, settings.exposure_stops));
  try {
    const OCIO::ConstCPUProcessorRcPtr view = state_->view_processor(settings);
    const OCIO::ConstCPUProcessorRcPtr gamma = state_->gamma_processor(settings.gamma);
    // Row by row: a row stays in the cache from the first step to the rounding. Exposure, look,
    // view, gamma is the order of Blender's own display transform.
    std::vector<float> row(row_values);
    OCIO::PackedImageDesc pixels(row.data(), combined.width, 1, kRgba);
    const float* from = combined.values.data();
    std::uint8_t* to = picture.values.data();
    for (int y = 0; y < combined.height; ++y, from += row_values) {
      for (std::size_t i = 0; i < row_values; ++i) row[i] = from[i] * scale;
      view->apply(pixels);
      if (gamma) gamma->apply(pixels);
      for (std::size_t i = 0; i < row_values; i += kRgba) {
        for (std::size_t c = 0; c < kRgb; ++c) *to++ = code_value(row[i + c]);
      }
    }
  } catch (const std::exception& exception) {
    return fail(ErrorKind::kInput, "{} cannot make the view '{}' of '{}': {}", state_->path,
                settings.view, settings.display, exception.what());
  }
  return picture;
}

const std::string& ColorManagement::config_hash() const { return state_->hash; }

}  // namespace seedframe
