// What a frame costs the program itself, apart from Blender, on one core, by stage
// (scripts/bench.sh).
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

#include "annotate/amodal.h"
#include "annotate/labels.h"
#include "base/canonical_writer.h"
#include "base/files.h"
#include "base/philox.h"
#include "base/sha256.h"
#include "frames/frame_finisher.h"
#include "frames/rendered_frame.h"
#include "image/pass_reader.h"
#include "image/pixel_hash.h"
#include "image/png_file.h"
#include "scene/prepared_campaign.h"
#include "tests/image/exr_writer.h"
#include "twin/twin_comparison.h"

namespace seedframe {
namespace {
namespace fs = std::filesystem;

constexpr auto kIdsOnly = TwinTracer::Passes::kIdsOnly;
constexpr const char* kOcioConfig = "/usr/share/blender/datafiles/colormanagement/config.ocio";

template <class T>
T value_or_exit(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().message.c_str());
    std::exit(1);
  }
  return std::move(*result);
}

/// Of one frame, what a worker would leave, and everything that comes of it.
class Frame {
 public:
  /// Of the bench's own scene with so many objects; 0: of the parts study, which has 200.
  Frame(std::int64_t objects, std::int64_t width, std::int64_t height) {
    const std::string home = SEEDFRAME_HOME;
    const std::string file =
        home + (objects == 0 ? "/configs/parts_study.yaml" : "/tests/bench/frame.yaml");
    std::vector<std::string> sets = {"render.width=" + std::to_string(width),
                                     "render.height=" + std::to_string(height)};
    if (objects > 0) sets.push_back("variables.campaign.n=" + std::to_string(objects));
    const PreparedCampaign campaign =
        value_or_exit(prepare(value_or_exit(read_source(file, sets, home))));
    ExpandedFrame expanded = value_or_exit(campaign.expander.expand(0));
    categories = campaign.settings.categories;
    task = {std::move(expanded.spec), std::move(expanded.id), std::move(expanded.meshes),
            folder_ / "attempt", folder_ / "rejected"};
    fs::create_directories(task.attempt_folder);
    twin.emplace(value_or_exit(tracer.trace(task.spec, task.meshes, kIdsOnly)));
    write_passes();
    passes = value_or_exit(read_passes(rendered(), expectation()));
    picture = value_or_exit(color().apply(passes.combined, task.spec.image));
  }
  ~Frame() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  fs::path rendered() const { return folder_ / "rendered.exr"; }
  PassExpectation expectation() const {
    return {.width = task.spec.render.width,
            .height = task.spec.render.height,
            .max_instance_id = 32767,
            .frame_id = task.frame_id};
  }
  static const ColorManagement& color() {
    static const ColorManagement loaded = value_or_exit(ColorManagement::load(kOcioConfig));
    return loaded;
  }

  FinishTask task;
  std::vector<std::string> categories;
  TwinTracer tracer;
  std::optional<Twin> twin;
  FramePasses passes;
  Image<std::uint8_t> picture;

 private:
  /// Blender's channels and types; colours by instance, with the noise of a few samples.
  void write_passes() const {
    ExrFile file;
    file.width = task.spec.render.width;
    file.height = task.spec.render.height;
    file.note = task.frame_id;
    const std::string layer = "ViewLayer.";
    const PhiloxStream noise(1, "noise");
    std::uint32_t draw = 0;
    for (const char* component : {"R", "G", "B"}) {
      file.fill(layer + "Combined." + component, Imf::HALF, 0.0F);
      for (int row = 0; row < file.height; ++row) {
        for (int column = 0; column < file.width; ++column) {
          const int id = twin->instance_ids.at(row, column);
          const double base = 0.1 + 0.05 * (id % 9);
          file.at(layer + "Combined." + component, row, column) =
              static_cast<float>(base * (0.8 + 0.4 * noise.uniform({.attempt = draw++})));
        }
      }
    }
    file.fill(layer + "Combined.A", Imf::HALF, 1.0F);
    file.fill(layer + "IndexOB.X", Imf::FLOAT, 0.0F);
    auto& index = file.channels.at(layer + "IndexOB.X").values;
    std::copy(twin->instance_ids.values.begin(), twin->instance_ids.values.end(), index.begin());
    file.write(rendered());
  }

  fs::path folder_ = [] {
    std::string pattern = (fs::temp_directory_path() / "seedframe-bench-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) std::exit(1);
    return fs::path(pattern);
  }();
};

Frame frame_of(const benchmark::State& state) {
  return Frame(state.range(0), state.range(1), state.range(2));
}

void twin(benchmark::State& state) {
  Frame frame = frame_of(state);
  for (auto _ : state) {
    const auto traced = frame.tracer.trace(frame.task.spec, frame.task.meshes, kIdsOnly);
    benchmark::DoNotOptimize(
        compare_with_twin(frame.task.spec, frame.passes.instance_ids, traced->instance_ids, {}));
  }
  state.counters["instances"] = static_cast<double>(frame.task.spec.instances.size());
}

void silhouettes(benchmark::State& state) {
  const Frame frame = frame_of(state);
  TwinTracer tracer;
  // So that meshes have their trees and edges, which a campaign makes once.
  const auto before = *tracer.trace(frame.task.spec, frame.task.meshes, kIdsOnly);
  benchmark::DoNotOptimize(before.silhouettes(before.instance_ids));
  for (auto _ : state) {
    // Anew each time, since a twin keeps what it has found out.
    state.PauseTiming();
    auto traced = std::make_optional(*tracer.trace(frame.task.spec, frame.task.meshes, kIdsOnly));
    state.ResumeTiming();
    benchmark::DoNotOptimize(traced->silhouettes(traced->instance_ids));
    state.PauseTiming();
    traced.reset();
    state.ResumeTiming();
  }
}

/// With their pixels' hashes.
void passes(benchmark::State& state) {
  const Frame frame = frame_of(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(read_passes(frame.rendered(), frame.expectation()));
  }
}

void colour(benchmark::State& state) {
  const Frame frame = frame_of(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(Frame::color().apply(frame.passes.combined, frame.task.spec.image));
  }
}

void png(benchmark::State& state) {
  const Frame frame = frame_of(state);
  const Image<std::uint8_t> semantic = semantic_image(frame.task.spec, frame.passes.instance_ids);
  for (auto _ : state) {
    benchmark::DoNotOptimize(encode_png(frame.picture));
    benchmark::DoNotOptimize(encode_png(frame.passes.instance_ids));
    benchmark::DoNotOptimize(encode_png(semantic));
  }
}

/// Those of the picture's pixels and of the files; the passes' are with them.
void hashes(benchmark::State& state) {
  const Frame frame = frame_of(state);
  const std::string png = encode_png(frame.picture);
  const auto exr = value_or_exit(read_file(frame.rendered()));
  for (auto _ : state) {
    benchmark::DoNotOptimize(pixel_hash(frame.picture, "R,G,B"));
    benchmark::DoNotOptimize(sha256_hex(png));
    benchmark::DoNotOptimize(sha256_hex(exr));
  }
}

/// With the silhouettes.
void labels(benchmark::State& state) {
  const Frame frame = frame_of(state);
  const Image<std::uint16_t>& ids = frame.passes.instance_ids;
  for (auto _ : state) {
    auto made = make_labels(frame.task.spec, frame.categories, ids);
    add_amodal_labels(*made, frame.task.spec, *frame.twin, ids);
    benchmark::DoNotOptimize(readable_layout(canonical_text(*made)));
    benchmark::DoNotOptimize(readable_layout(canonical_text(frame.task.spec)));
    benchmark::DoNotOptimize(semantic_image(frame.task.spec, ids));
  }
}

/// All of it, from the worker's file to the files of the frame.
void whole(benchmark::State& state) {
  const Frame frame = frame_of(state);
  FrameFinisher finisher(frame.categories, {}, 1);
  const auto put_in_place = [&] {
    fs::copy_file(frame.rendered(), rendered_passes(frame.task.attempt_folder),
                  fs::copy_options::overwrite_existing);
  };
  put_in_place();
  value_or_exit(finisher.finish(frame.task, Frame::color()));  // builds the meshes' trees
  for (auto _ : state) {
    state.PauseTiming();
    put_in_place();
    state.ResumeTiming();
    benchmark::DoNotOptimize(finisher.finish(frame.task, Frame::color()));
  }
}

void scenes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond);
  for (const std::int64_t objects : {0, 1, 26, 200, 1000}) {
    benchmark->Args({objects, 640, 480})->Args({objects, 128, 128});
  }
}
BENCHMARK(twin)->Apply(scenes);
BENCHMARK(silhouettes)->Apply(scenes);
BENCHMARK(passes)->Apply(scenes);
BENCHMARK(colour)->Apply(scenes);
BENCHMARK(png)->Apply(scenes);
BENCHMARK(hashes)->Apply(scenes);
BENCHMARK(labels)->Apply(scenes);
BENCHMARK(whole)->Apply(scenes);

}  // namespace
}  // namespace seedframe

BENCHMARK_MAIN();
