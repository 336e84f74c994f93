// Whatever stands in a config that can be read: its first frames are expanded, or refused with a
// message for its author; soon.

#include <chrono>

#include <gtest/gtest.h>

#include "base/files.h"
#include "config/campaign_config.h"
#include "scene/expander.h"
#include "scene/material_library.h"
#include "tests/config/config_mutations.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

/// Of the built-in library the names, with files so small that hashing them takes no time.
class SmallLibrary {
 public:
  SmallLibrary() {
    const auto all = MaterialLibrary::open({fs::path(SEEDFRAME_HOME) / "materials"}, {});
    EXPECT_TRUE(all);
    for (const auto& [name, material] : all->materials()) own_.push_back(material);
    for (const std::string& name : all->texture_set_names()) {
      const fs::path folder = folder_.path() / "textures" / name;
      fs::create_directories(folder);
      EXPECT_TRUE(write_file(folder / (name + "_Color.png"), name));
    }
    fs::create_directories(folder_ / "hdri");
    for (const std::string& name : all->hdri_names()) {
      EXPECT_TRUE(write_file(folder_ / "hdri" / (name + ".exr"), name));
    }
  }

  Result<MaterialLibrary> open(std::vector<MaterialConfig> own) const {
    own.insert(own.end(), own_.begin(), own_.end());
    return MaterialLibrary::open({folder_.path()}, own);
  }

 private:
  ScratchFolder folder_;
  std::vector<MaterialConfig> own_;
};

class MalformedScene : public ::testing::Test {
 protected:
  /// The first error, or nothing.
  Result<std::size_t> expand(const NamedText& text) {
    const auto config = read_campaign_config(text.text, text.file);
    if (!config) return forward_error(config);
    auto materials = library_.open(config->materials);
    if (!materials) return forward_error(materials);
    auto expander = SceneExpander::compile(*config, assets_, *materials);
    if (!expander) return forward_error(expander);
    std::size_t instances = 0;
    const std::int64_t frames = std::min<std::int64_t>(expander->frame_count(), 2);
    for (std::int64_t i = 0; i < frames; ++i) {
      const auto frame = expander->expand(i, {.id = true, .draws = true, .graph = true});
      if (!frame) return forward_error(frame);
      canonical_json(frame->graph);
      for (const Draw& draw : frame->draws) canonical_json(draw.value);
      instances += frame->spec.instances.size();
    }
    return instances;
  }

  /// True if its frames could be expanded.
  bool try_scene(const NamedText& text) {
    const auto start = std::chrono::steady_clock::now();
    bool good = false;
    try {
      const auto expanded = expand(text);
      if (!expanded) expect_readable(expanded.error().message, text.text);
      good = expanded.has_value();
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what() << "\n" << text.text;
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 20.0) << text.text;
    return good;
  }

  void try_mutations(const NamedText& text, std::uint32_t seed, int count) {
    ASSERT_TRUE(try_scene(text)) << text.file << ": " << expand(text).error().message;
    ConfigMutations mutations(seed);
    int accepted = 0;
    for (int i = 0; i < count && !HasFailure(); ++i) {
      accepted += try_scene({text.file, mutations.mutated(text.text)}) ? 1 : 0;
    }
    if (count < 100) return;
    EXPECT_GT(accepted, count / 100) << text.file;
    EXPECT_LT(accepted, count * 4 / 5) << text.file;
  }

 private:
  SmallLibrary library_;
  AssetLibrary assets_ = *AssetLibrary::open({fs::path(SEEDFRAME_HOME) / "assets"});
};

TEST_F(MalformedScene, EverythingMutated) { try_mutations({"all.yaml", kEverything}, 2, 6000); }

TEST_F(MalformedScene, EveryExampleMutated) {
  std::uint32_t seed = 200;
  for (const NamedText& config : example_configs()) {
    if (config.text.find("\nbase:") != std::string::npos) continue;
    try_mutations(config, ++seed, 150);
  }
}

}  // namespace
}  // namespace seedframe
