// What the twin of a frame costs, on one core (scripts/bench.sh).
#include <cstdio>
#include <cstdlib>

#include <benchmark/benchmark.h>

#include "campaign/prepared_campaign.h"
#include "twin/twin.h"

namespace seedframe {
namespace {

struct Frame {
  FrameSpec spec;
  MeshBuffers buffers;
  std::size_t triangles = 0;
};

/// The first frame of the demo config at a size, with what its instances need.
Frame demo_frame(int width, int height) {
  const std::string file = std::string(SEEDFRAME_HOME) + "/configs/parts.yaml";
  auto source = read_source(file,
                            {{"render.width", std::to_string(width)},
                             {"render.height", std::to_string(height)}},
                            SEEDFRAME_HOME);
  auto campaign = prepare(std::move(*source));
  if (!campaign) {
    std::fprintf(stderr, "%s\n", campaign.error().message.c_str());
    std::exit(1);
  }
  auto expanded = campaign->expander.expand(0);
  Frame frame{expanded->spec, campaign->expander.mesh_buffers(), 0};
  for (const InstanceSpec& instance : frame.spec.instances) {
    if (!frame.buffers.contains(instance.mesh)) {
      frame.buffers[instance.mesh] = expanded->ground_buffer;
    }
  }
  return frame;
}

/// All trees built anew.
void cold(benchmark::State& state) {
  const Frame frame = demo_frame(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  for (auto _ : state) benchmark::DoNotOptimize(TwinTracer().trace(frame.spec, frame.buffers));
}

/// The trees of the meshes are there, as from the second frame of a campaign on.
void warm(benchmark::State& state) {
  const Frame frame = demo_frame(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  TwinTracer tracer;
  for (auto _ : state) benchmark::DoNotOptimize(tracer.trace(frame.spec, frame.buffers));
  state.counters["instances"] = static_cast<double>(frame.spec.instances.size());
}

void silhouettes(benchmark::State& state) {
  const Frame frame = demo_frame(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  TwinTracer tracer;
  const auto twin = tracer.trace(frame.spec, frame.buffers);
  for (auto _ : state) benchmark::DoNotOptimize(twin->silhouettes(twin->instance_ids));
}

BENCHMARK(cold)->Args({640, 480})->Args({128, 128})->Unit(benchmark::kMillisecond);
BENCHMARK(warm)->Args({640, 480})->Args({128, 128})->Unit(benchmark::kMillisecond);
BENCHMARK(silhouettes)->Args({640, 480})->Args({128, 128})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace seedframe

BENCHMARK_MAIN();
