// Draws that should have nothing to do with each other, and draws that must stay where they are.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/scene/scene_fixture.h"
#include "tests/scene/statistics.h"

namespace seedframe {
namespace {

constexpr int kScenes = 10'000;

constexpr const char* kMany = R"(seedframe: 1
seed: 8
scenes: 10000
frames_per_scene: 2
variables:
  scene:
    a: {uniform: [0, 1]}
    b: {uniform: [0, 1]}
    even: {sobol: [0, {uniform: [0, 1]}]}
    even2: {sobol: [1, {uniform: [0, 1]}]}
    v: [{uniform: [0, 1]}, {uniform: [0, 1]}, {uniform: [0, 1]}]
  frame: {f: {uniform: [0, 1]}}
objects:
  twins: {asset: cube, category: none, count: 2, variables: {t: {uniform: [0, 1]}}}
camera: {distance_m: 1}
)";

using Columns = std::map<std::string, std::vector<double>>;

/// Every variable of every scene; those of frames and copies by "f/0", "f/1".
Columns columns_of(const std::string& text) {
  Columns columns;
  auto expander = expander_of(text);
  EXPECT_TRUE(expander) << expander.error().message;
  if (!expander) return columns;
  for (std::int64_t scene = 0; scene < kScenes; ++scene) {
    for (const std::int64_t view : {0, 1}) {
      const auto frame = expander->expand(2 * scene + view, {.id = false, .graph = true});
      EXPECT_TRUE(frame) << frame.error().message;
      if (!frame) return columns;
      const Json& graph = frame->graph;
      columns["f/" + std::to_string(view)].push_back(graph.at("f").get<double>());
      if (view == 1) continue;
      for (const char* name : {"a", "b", "even", "even2"}) {
        columns[name].push_back(graph.at(name).get<double>());
      }
      for (std::size_t i = 0; i < 3; ++i) {
        columns["v/" + std::to_string(i)].push_back(graph.at("v")[i].get<double>());
      }
      for (std::size_t i = 0; i < 2; ++i) {
        columns["t/" + std::to_string(i)].push_back(graph.at("objects.twins.t")[i].get<double>());
      }
    }
  }
  return columns;
}

const Columns& many() {
  static const Columns columns = columns_of(kMany);
  return columns;
}

TEST(Independence, VariablesFramesAndCopiesAreNotCorrelated) {
  ASSERT_EQ(many().size(), 11u);
  for (const auto& [name, x] : many()) {
    ASSERT_EQ(x.size(), static_cast<std::size_t>(kScenes));
    for (const auto& [other, y] : many()) {
      if (name >= other) continue;
      EXPECT_GT(independence_p(x, y), kLeastP) << name << " and " << other;
    }
  }
}

TEST(Independence, NeighbouringScenesAreNotCorrelated) {
  for (const char* name : {"a", "f/0", "t/1"}) {
    const std::vector<double>& x = many().at(name);
    const std::vector<double> now(x.begin(), x.end() - 1);
    const std::vector<double> next(x.begin() + 1, x.end());
    EXPECT_GT(independence_p(now, next), kLeastP) << name;
  }
}

TEST(Independence, PairsFillTheSquareEvenly) {
  for (const auto& [x, y] : std::vector<std::pair<std::string, std::string>>{
           {"a", "b"}, {"f/0", "f/1"}, {"t/0", "t/1"}, {"v/0", "v/2"}, {"even", "a"}}) {
    std::vector<double> counts(100, 0.0);
    for (std::size_t i = 0; i < kScenes; ++i) {
      const auto column = static_cast<std::size_t>(10.0 * many().at(x)[i]);
      const auto row = static_cast<std::size_t>(10.0 * many().at(y)[i]);
      counts[10 * row + column] += 1.0;
    }
    EXPECT_GT(chi_squared_p(counts, std::vector<double>(100, kScenes / 100.0)), kLeastP)
        << x << " and " << y;
  }
}

TEST(Independence, TwoDimensionsOfSobolFillTheSquareEvenerThanChance) {
  std::vector<double> counts(64, 0.0);
  for (std::size_t i = 0; i < 8192; ++i) {
    const auto column = static_cast<std::size_t>(8.0 * many().at("even")[i]);
    const auto row = static_cast<std::size_t>(8.0 * many().at("even2")[i]);
    counts[8 * row + column] += 1.0;
  }
  for (const double count : counts) EXPECT_EQ(count, 128.0);
}

TEST(Independence, SeedsAreNotCorrelated) {
  std::string other = kMany;
  other.replace(other.find("seed: 8"), 7, "seed: 9");
  const Columns columns = columns_of(other);
  EXPECT_GT(independence_p(many().at("a"), columns.at("a")), kLeastP);
  // One dimension scrambled twice may look alike by halves, but is another sequence.
  EXPECT_NE(many().at("even"), columns.at("even"));
}

/// The values of the variable "x" in the first 200 scenes.
std::vector<double> x_of(const std::string& definition) {
  std::vector<double> values;
  for (const ExpandedFrame& frame :
       all_frames("seedframe: 1\nseed: 4\nscenes: 200\ncamera: {distance_m: 1}\nvariables: {scene: "
                  "{x: " +
                  definition + "}}\n")) {
    values.push_back(frame.graph.at("x").get<double>());
  }
  return values;
}

TEST(Quantiles, StayWhenParametersMove) {
  const std::vector<double> unit = x_of("{uniform: [0, 1]}");
  const std::vector<double> wide = x_of("{uniform: [10, 30]}");
  const std::vector<double> bell = x_of("{normal: [3, 2]}");
  const std::vector<double> cut = x_of("{truncated_normal: [0, 1, -9, 9]}");
  const std::vector<double> log = x_of("{log_uniform: [1, 100]}");
  const std::vector<double> dice = x_of("{integer: [1, 6]}");
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const double u = unit[i];
    EXPECT_NEAR(wide[i], 10.0 + 20.0 * u, 1e-12);
    EXPECT_NEAR(0.5 * std::erfc(-(bell[i] - 3.0) / 2.0 / std::sqrt(2.0)), u, 1e-12);
    EXPECT_NEAR(0.5 * std::erfc(-cut[i] / std::sqrt(2.0)), u, 1e-12);
    EXPECT_NEAR(std::log(log[i]) / std::log(100.0), u, 1e-12);
    EXPECT_EQ(dice[i], 1.0 + std::floor(6.0 * u));
  }
}

TEST(Quantiles, OfSobolStayWhenParametersMove) {
  const std::vector<double> unit = x_of("{sobol: [5, {uniform: [0, 1]}]}");
  const std::vector<double> wide = x_of("{sobol: [5, {uniform: [-1, 1]}]}");
  for (std::size_t i = 0; i < unit.size(); ++i) EXPECT_NEAR(wide[i], 2.0 * unit[i] - 1.0, 1e-12);
}

TEST(Quantiles, DrawsAreFarFromOtherNamesAndNearThemselves) {
  const std::vector<double> once = x_of("{uniform: [0, 1]}");
  EXPECT_EQ(once, x_of("{uniform: [0, 1]}"));
  EXPECT_NE(once, x_of("{sobol: [0, {uniform: [0, 1]}]}"));
}

}  // namespace
}  // namespace seedframe
