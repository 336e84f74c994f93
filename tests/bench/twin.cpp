// What the twin of a frame costs, on one core (scripts/bench.sh).
#include "twin/twin.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <benchmark/benchmark.h>

#include "scene/prepared_campaign.h"
#include "tests/mesh/example_meshes.h"
#include "twin/twin_comparison.h"

namespace seedframe {
namespace {

constexpr auto kIdsOnly = TwinTracer::Passes::kIdsOnly;
constexpr auto kAsked = TwinTracer::Passes::kAsked;

struct Frame {
  FrameSpec spec;
  MeshBuffers buffers;
};

/// All frames of the demo config at a size.
std::vector<Frame> demo_frames(const benchmark::State& state) {
  const std::string file = SEEDFRAME_HOME "/configs/parts.yaml";
  auto source = read_source(file,
                            {"render.width=" + std::to_string(state.range(0)),
                             "render.height=" + std::to_string(state.range(1))},
                            SEEDFRAME_HOME);
  auto campaign = prepare(std::move(*source));
  if (!campaign) {
    std::fprintf(stderr, "%s\n", campaign.error().message.c_str());
    std::exit(1);
  }
  std::vector<Frame> frames;
  for (std::int64_t i = 0; i < campaign->expander.frame_count(); ++i) {
    const auto expanded = campaign->expander.expand(i);
    frames.push_back({expanded->spec, expanded->meshes});
  }
  return frames;
}

/// The one with the most instances.
Frame fullest(const std::vector<Frame>& frames) {
  return *std::max_element(frames.begin(), frames.end(), [](const Frame& a, const Frame& b) {
    return a.spec.instances.size() < b.spec.instances.size();
  });
}

/// Every tree built anew, those of the meshes too.
void first_frame(benchmark::State& state) {
  const Frame frame = demo_frames(state).front();
  for (auto _ : state) {
    benchmark::DoNotOptimize(TwinTracer().trace(frame.spec, frame.buffers, kIdsOnly));
  }
}

/// As from the second frame of a campaign on: the tree of the instances is built, those of the
/// meshes are there. One frame after the other.
void trace(benchmark::State& state, const std::vector<Frame>& frames, TwinTracer::Passes passes) {
  TwinTracer tracer;
  for (const Frame& frame : frames) {
    benchmark::DoNotOptimize(tracer.trace(frame.spec, frame.buffers, kIdsOnly));
  }
  std::size_t next = 0;
  for (auto _ : state) {
    const Frame& frame = frames[next++ % frames.size()];
    benchmark::DoNotOptimize(tracer.trace(frame.spec, frame.buffers, passes));
  }
}
void ids(benchmark::State& state) { trace(state, demo_frames(state), kIdsOnly); }
void ids_depth_normals(benchmark::State& state) { trace(state, demo_frames(state), kAsked); }
void fullest_ids(benchmark::State& state) { trace(state, {fullest(demo_frames(state))}, kIdsOnly); }

void silhouettes(benchmark::State& state) {
  const Frame frame = fullest(demo_frames(state));
  TwinTracer tracer;
  const auto twin = tracer.trace(frame.spec, frame.buffers, kIdsOnly);
  for (auto _ : state) benchmark::DoNotOptimize(twin->silhouettes(twin->instance_ids));
  state.counters["instances"] = static_cast<double>(frame.spec.instances.size());
}

/// All that a rendered frame costs more because of its twin.
void check(benchmark::State& state) {
  const std::vector<Frame> frames = demo_frames(state);
  TwinTracer tracer;
  std::size_t next = 0;
  for (auto _ : state) {
    const Frame& frame = frames[next++ % frames.size()];
    const auto twin = tracer.trace(frame.spec, frame.buffers, kIdsOnly);
    Image<std::uint16_t> rendered = twin->instance_ids;
    rendered.values[0] ^= 1;  // so that nothing is taken for equal at once
    benchmark::DoNotOptimize(compare_with_twin(frame.spec, rendered, twin->instance_ids, {}));
    benchmark::DoNotOptimize(twin->silhouettes(rendered));
  }
}

/// Embree's bytes for a mesh of 2 n² triangles, and for 1,000 instances of it.
void memory(benchmark::State& state) {
  const auto n = static_cast<std::uint32_t>(state.range(0));
  const Mesh mesh = example_patch(n);
  const PixelCamera camera{16, 16, {16, 16}, {7.5, 7.5}, 0.01, 100};
  double once = 0, instanced = 0;
  for (auto _ : state) {
    const std::size_t before = ray_tracing_bytes();
    const auto tree = std::make_shared<const RayMesh>(mesh);
    once = static_cast<double>(ray_tracing_bytes() - before);
    const RayScene scene(camera, std::vector<RayInstance>(1000, {tree}));
    instanced = static_cast<double>(ray_tracing_bytes() - before) - once;
  }
  state.counters["bytes_per_triangle"] = once / (2.0 * n * n);
  state.counters["bytes_per_instance"] = instanced / 1000.0;
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({640, 480})->Args({128, 128})->Unit(benchmark::kMillisecond);
}
BENCHMARK(first_frame)->Apply(sizes);
BENCHMARK(ids)->Apply(sizes);
BENCHMARK(ids_depth_normals)->Apply(sizes);
BENCHMARK(fullest_ids)->Apply(sizes);
BENCHMARK(silhouettes)->Apply(sizes);
BENCHMARK(check)->Apply(sizes)->Args({320, 240});
BENCHMARK(memory)->Arg(16)->Arg(64)->Arg(256)->Arg(1024)->Iterations(1);

}  // namespace
}  // namespace seedframe

BENCHMARK_MAIN();
