// What holds for every config that is shipped.

#include <algorithm>

#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/scene/scene_fixture.h"
#include "tests/scene/statistics.h"

namespace seedframe {
namespace {

std::vector<std::filesystem::path> shipped_configs() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(kHome / "configs")) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Result<CampaignConfig> read_shipped(const std::filesystem::path& file,
                                    const std::vector<Override>& changes,
                                    const AllowedFolders& allowed = {}) {
  const Result<std::string> text = read_file(file);
  if (!text) return forward_error(text);
  return read_campaign_config(*text, file, changes, allowed);
}

Result<SceneExpander> shipped_expander(CampaignConfig config) {
  auto materials = MaterialLibrary::open({kHome / "materials"}, config.materials);
  if (!materials) return forward_error(materials);
  std::shared_ptr<const Graphs> graphs;
  if (config.graphs) {
    auto opened = Graphs::open(*config.graphs);
    if (!opened) return forward_error(opened);
    config.scenes = opened->size();
    graphs = std::make_shared<const Graphs>(std::move(*opened));
  }
  return SceneExpander::compile(config, built_in_assets(), *materials, std::move(graphs));
}

/// The graphs of its first frame, and of one of another scene if there is one.
std::vector<Json> some_graphs(const std::filesystem::path& file) {
  std::vector<Json> graphs;
  const auto config = read_shipped(file, {});
  EXPECT_TRUE(config) << config.error().message;
  if (!config) return graphs;
  const auto expander = shipped_expander(*config);
  EXPECT_TRUE(expander) << expander.error().message;
  if (!expander) return graphs;
  graphs.push_back(frame_of(*expander).graph);
  if (config->scenes > 1) graphs.push_back(frame_of(*expander, config->frames_per_scene).graph);
  return graphs;
}

TEST(ShippedConfigs, TakeGraphsWithOneLineAFrame) {
  const ScratchFolder scratch;
  for (const std::filesystem::path& file : shipped_configs()) {
    SCOPED_TRACE(file.filename());
    const std::vector<Json> graphs = some_graphs(file);
    ASSERT_FALSE(graphs.empty());
    std::string lines;
    for (const Json& graph : graphs) lines += canonical_json(graph) + "\n";
    const std::filesystem::path path = scratch.path() / "graphs.jsonl";
    ASSERT_TRUE(write_file(path, lines));
    const auto config =
        read_shipped(file, {{"graphs", path.string()}}, AllowedFolders({scratch.path()}));
    ASSERT_TRUE(config) << config.error().message;
    const auto expander = shipped_expander(*config);
    ASSERT_TRUE(expander) << expander.error().message;
    ASSERT_EQ(expander->frame_count(), static_cast<std::int64_t>(graphs.size()));
    for (std::size_t i = 0; i < graphs.size(); ++i) {
      EXPECT_EQ(frame_of(*expander, static_cast<std::int64_t>(i)).graph, graphs[i]);
    }
  }
}

TEST(ShippedConfigs, GraphsMayStillHaveSeveralFramesALine) {
  const ScratchFolder scratch;
  const std::filesystem::path path = scratch.path() / "graphs.jsonl";
  ASSERT_TRUE(write_file(path, "{}\n{}\n"));
  const std::filesystem::path file = kHome / "configs" / "parts.yaml";
  const AllowedFolders allowed({scratch.path()});
  const Override graphs{"graphs", path.string()};
  const Override frames{"frames_per_scene", "3"};
  for (const std::vector<Override>& changes :
       std::vector<std::vector<Override>>{{graphs, frames}, {frames, graphs}}) {
    const auto config = read_shipped(file, changes, allowed);
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->frames_per_scene, 3);
  }
}

struct StudyParameter {
  const char* name;  ///< in parts_study.yaml: <name>_mean and <name>_std
  const char* drawn;
  double min;
  double max;
};

constexpr StudyParameter kStudy[] = {{"n", "n_draw", 1, 400},
                                     {"target_share", "target_share", 0, 1},
                                     {"r", "r", 0, 1},
                                     {"cc_share", "cc_share", 0, 1},
                                     {"roughness", "roughness", 0, 1},
                                     {"metallicity", "metallicity", 0, 1},
                                     {"a", "a", 0, 2},
                                     {"n_lights", "n_lights_draw", 1, 20},
                                     {"d_min", "d_min", 0.1, 5},
                                     {"d_max", "d_max_draw", 0.1, 5},
                                     {"scale", "scale", 0.2, 3},
                                     {"area", "area", 0.01, 10},
                                     {"light_power", "light_power", 0, 1000},
                                     {"light_temperature", "light_temperature", 1500, 15000},
                                     {"light_distance", "light_distance", 0, 5},
                                     {"light_height", "light_height", 0.2, 5},
                                     {"background", "background", 0, 5},
                                     {"elevation", "elevation", 5, 90},
                                     {"fov", "fov", 10, 120}};

TEST(PartsStudy, EveryNormalParameterHasTheMeanAndTheDeviationThatAreSet) {
  constexpr int kStudyScenes = 300;
  for (const double at : {0.1, 0.5, 0.9}) {
    std::vector<Override> changes = {{"objects", "null"},
                                     {"ground", "null"},
                                     {"lights", "null"},
                                     {"frames_per_scene", "1"},
                                     {"scenes", std::to_string(kStudyScenes)}};
    const auto mean = [&](const StudyParameter& p) { return p.min + at * (p.max - p.min); };
    // A normal one has this deviation at every one of these means, though not 0.1 without bounds.
    const auto deviation = [&](const StudyParameter& p) {
      return (at == 0.5 ? 0.25 : 0.08) * (p.max - p.min);
    };
    for (const StudyParameter& p : kStudy) {
      const std::string path = std::string("variables.campaign.") + p.name;
      changes.push_back({path + "_mean", fmt::format("{}", mean(p))});
      changes.push_back({path + "_std", fmt::format("{}", deviation(p))});
    }
    const auto config = read_shipped(kHome / "configs" / "parts_study.yaml", changes);
    ASSERT_TRUE(config) << config.error().message;
    const auto expander = shipped_expander(*config);
    ASSERT_TRUE(expander) << expander.error().message;
    std::map<std::string, std::vector<double>> drawn;
    for (std::int64_t scene = 0; scene < kStudyScenes; ++scene) {
      const auto frame = expander->expand(scene, {.id = false, .graph = true});
      ASSERT_TRUE(frame) << frame.error().message;
      for (const StudyParameter& p : kStudy) {
        drawn[p.name].push_back(frame->graph.at(p.drawn).get<double>());
      }
    }
    for (const StudyParameter& p : kStudy) {
      SCOPED_TRACE(fmt::format("{} with mean {} and std {}", p.name, mean(p), deviation(p)));
      double squares = 0.0;
      for (const double x : drawn[p.name]) squares += (x - mean(p)) * (x - mean(p));
      // 4 standard deviations of the estimates; that of the second is wider where a tail is long.
      EXPECT_NEAR(mean_of(drawn[p.name]), mean(p), 4.0 * deviation(p) / std::sqrt(kStudyScenes));
      EXPECT_NEAR(std::sqrt(squares / kStudyScenes), deviation(p),
                  6.0 * deviation(p) / std::sqrt(2.0 * kStudyScenes));
    }
  }
}

TEST(PartsStudy, ADeviationThatNoNormalParameterHasIsRefused) {
  const auto config = read_shipped(kHome / "configs" / "parts_study.yaml",
                                   {{"variables.campaign.metallicity_std", "0.2"}});
  ASSERT_TRUE(config) << config.error().message;
  const auto expander = shipped_expander(*config);
  ASSERT_TRUE(expander) << expander.error().message;
  const auto frame = expander->expand(0);
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().kind, ErrorKind::kInput);
  EXPECT_NE(frame.error().message.find("has mean 0.965 and std 0.2: with this mean, std must be "
                                       "below 0.035"),
            std::string::npos)
      << frame.error().message;
}

}  // namespace
}  // namespace seedframe
