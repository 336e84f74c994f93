// How fast configs become frame specs and frame ids, on one core (scripts/bench.sh).
#include <filesystem>
#include <fstream>

#include <benchmark/benchmark.h>

#include "scene/prepared_campaign.h"

namespace seedframe {
namespace {

/// What a first config looks like: one object on a ground, one light, a camera around it.
constexpr const char* kSimple = R"(seedframe: 1
seed: 1
scenes: 1000000
categories: [gear]
objects:
  part:
    asset: gear
    rotation_deg: [0, 0, {uniform: [0, 360]}]
    rest_on_ground: true
    material: aluminium
lights:
  key: {position: [{uniform: [-1, 1]}, -1, 2], power: {uniform: [50, 100]}}
camera: {target: [0, 0, 0], distance_m: {uniform: [0.3, 0.6]}, azimuth_deg: {uniform: [0, 360]}}
)";

PreparedCampaign prepared(const std::string& text, const std::filesystem::path& file,
                          const std::vector<Override>& overrides) {
  Result<PreparedCampaign> campaign = prepare({text, file, overrides, SEEDFRAME_HOME});
  if (!campaign) {
    std::fprintf(stderr, "%s\n", campaign.error().message.c_str());
    std::exit(1);
  }
  return std::move(*campaign);
}

void expand(benchmark::State& state, PreparedCampaign campaign) {
  std::int64_t frame = 0;
  for (auto _ : state) {
    const auto expanded = campaign.expander.expand(frame++ % campaign.expander.frame_count());
    if (!expanded) state.SkipWithError(expanded.error().message.c_str());
  }
  state.SetItemsProcessed(state.iterations());
}

void simple_config(benchmark::State& state) { expand(state, prepared(kSimple, "simple.yaml", {})); }

void robocup_without_visibility_test(benchmark::State& state) {
  const std::filesystem::path file =
      std::filesystem::path(SEEDFRAME_HOME) / "configs/robocup_spl.yaml";
  std::ifstream in(file);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  expand(state, prepared(text, file, {{"constraints", "{}"}, {"scenes", "100000"}}));
}

void robocup_with_visibility_test(benchmark::State& state) {
  const std::filesystem::path file =
      std::filesystem::path(SEEDFRAME_HOME) / "configs/robocup_spl.yaml";
  std::ifstream in(file);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  expand(state, prepared(text, file, {{"scenes", "100000"}}));
}

BENCHMARK(simple_config);
BENCHMARK(robocup_without_visibility_test);
BENCHMARK(robocup_with_visibility_test);

}  // namespace
}  // namespace seedframe

BENCHMARK_MAIN();
