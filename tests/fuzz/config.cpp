#include <algorithm>
#include <filesystem>

#include "config/campaign_config.h"
#include "scene/expander.h"
#include "scene/material_library.h"
#include "spec/frame_spec_reader.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/targets.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

/// A message is for the author of the config, and has no words that are not the author's.
void check_error(const Error& error, std::string_view config) {
  promise(error.kind == ErrorKind::kInput, "a wrong config is for its author to fix");
  for (const char* word : {"std::", "yaml-cpp", "bad conversion", "basic_string", "[json."}) {
    promise(error.message.find(word) == std::string::npos || config.find(word) != config.npos,
            "an error is for a config's author");
  }
}

const AssetLibrary& built_in_assets() {
  static const AssetLibrary library = *AssetLibrary::open({fs::path(SEEDFRAME_HOME) / "assets"});
  return library;
}

/// With those built-in materials that need no image files.
Result<MaterialLibrary> materials_of(const CampaignConfig& config) {
  static const std::vector<MaterialConfig> built_in = [] {
    const auto library = MaterialLibrary::open({fs::path(SEEDFRAME_HOME) / "materials"}, {});
    std::vector<MaterialConfig> plain;
    for (const auto& [name, material] : library->materials()) {
      if (!material.textures) plain.push_back(material);
    }
    return plain;
  }();
  std::vector<MaterialConfig> all = config.materials;
  all.insert(all.end(), built_in.begin(), built_in.end());
  return MaterialLibrary::open({}, all);
}

void limit_count(NumberSource& count) {
  const double* number = std::get_if<double>(&count.value);
  count.value = number == nullptr ? 2.0 : std::min(*number, 3.0);
}

/// So that a frame of any config is small: thirty thousand objects are no mistake, but slow.
void limit_copies(std::vector<ObjectConfig>& objects) {
  for (ObjectConfig& object : objects) {
    limit_count(object.count);
    if (object.grid) {
      for (NumberSource& count : object.grid->counts) limit_count(count);
    }
    limit_copies(object.objects);
  }
}

void expand_first_frame(CampaignConfig config, const MaterialLibrary& materials,
                        std::string_view text) {
  limit_copies(config.objects);
  config.max_attempts = std::min(config.max_attempts, 2);
  auto expander = SceneExpander::compile(config, built_in_assets(), materials);
  if (!expander) return check_error(expander.error(), text);
  const auto frame = expander->expand(0, {.id = true, .draws = true, .graph = true});
  if (!frame) return check_error(frame.error(), text);
  canonical_json(frame->graph);
  for (const Draw& draw : frame->draws) canonical_json(draw.value);
  promise(frame_spec_from_json(to_json(frame->spec), "spec.json").has_value(),
          "the spec of a frame can be read");
}

}  // namespace

void fuzz_config(std::string_view text) {
  // Beside it are files that a config may name.
  const fs::path file = fs::path(SEEDFRAME_HOME) / "tests/fuzz/beside_config/fuzz.yaml";
  const auto config = read_campaign_config(std::string(text), file);
  if (!config) return check_error(config.error(), text);
  const auto materials = materials_of(*config);
  if (!materials) return check_error(materials.error(), text);
  const auto expander = SceneExpander::compile(*config, built_in_assets(), *materials);
  if (!expander) return check_error(expander.error(), text);
  expand_first_frame(*config, *materials, text);
}

}  // namespace seedframe
