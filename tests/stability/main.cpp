// Renders every case with Blender, traces it with the twin, and asks CGAL about some of the pixels.
// Prints one line of JSON a case; stability.py makes the table.
//
//   stability <folder for scratch files>

#include <cstdio>
#include <cstdlib>
#include <random>

#include "base/files.h"
#include "image/pass_reader.h"
#include "render/blender_info.h"
#include "render/local_executor.h"
#include "render/worker_pool.h"
#include "tests/stability/cases.h"
#include "tests/stability/exact_hits.h"
#include "twin/twin.h"
#include "twin/twin_comparison.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using Ids = Image<std::uint16_t>;

[[noreturn]] void give_up(const std::string& why) {
  std::fprintf(stderr, "stability: %s\n", why.c_str());
  std::exit(1);
}

/// One worker that renders the frames of one case.
class Renderer : public RenderClient {
 public:
  Renderer(const StabilityCase& scenes, fs::path folder, std::map<std::string, fs::path> meshes,
           const fs::path& scripts)
      : scenes_(scenes), folder_(std::move(folder)), meshes_(std::move(meshes)) {
    const auto blender = probe_blender();
    if (!blender) give_up(blender.error().message);
    PoolOptions options;
    WorkerOptions worker;
    worker.blender = blender->program;
    worker.scripts = scripts;
    worker.log_path = [this](int) { return folder_ / "worker.log"; };
    worker.threads = 2;
    options.attempts = {1, 1};
    const auto& origin = scenes.blender_origin_m;
    worker.environment["SEEDFRAME_STABILITY_ORIGIN"] =
        fmt::format("{},{},{}", origin[0], origin[1], origin[2]);
    executor_ = std::make_unique<LocalExecutor>(worker);
    pool_ = std::make_unique<WorkerPool>(options, *executor_, *this);
  }

  std::vector<Ids> render() {
    ids_.resize(scenes_.frames.size());
    std::vector<PendingFrame> pending;
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      pending.push_back({static_cast<std::int64_t>(i), 0});
    }
    const auto summary = pool_->run(pending);
    if (!summary) give_up(summary.error().message);
    if (summary->failed > 0) give_up(scenes_.group + ", " + scenes_.name + ": " + failure_);
    return std::move(ids_);
  }

 private:
  Result<std::optional<RenderRequest>> request(const FrameJob& job) override {
    RenderRequest request;
    request.spec = canonical_text(scenes_.frames[static_cast<std::size_t>(job.frame)]);
    request.output = folder_ / "passes.exr";
    request.meshes = meshes_;
    return request;
  }
  void started(const FrameJob&, int) override {}
  void rendered(const FrameJob& job, const RenderTimings&, int) override {
    const FrameSpec& spec = scenes_.frames[static_cast<std::size_t>(job.frame)];
    auto passes = read_passes(folder_ / "passes.exr",
                              {spec.render.width, spec.render.height, false, false, 32767});
    if (passes) ids_[static_cast<std::size_t>(job.frame)] = std::move(passes->instance_ids);
    pool_->post_verdict(job, passes ? Status() : Status(forward_error(passes)));
  }
  Status check_system() override { return {}; }
  void attempt_failed(const FrameJob&, const AttemptFailure& failure) override {
    const std::string& message = failure.message;
    failure_ = message;
  }
  void worker_ready(int, const ReadyMessage&) override {}

  const StabilityCase& scenes_;
  fs::path folder_;
  std::map<std::string, fs::path> meshes_;
  std::vector<Ids> ids_;
  std::string failure_;
  std::unique_ptr<LocalExecutor> executor_;
  std::unique_ptr<WorkerPool> pool_;
};

/// What CGAL says of some pixels of a case.
struct ExactTally {
  int asked = 0;
  int ties = 0;          ///< two instances at exactly one depth: either answer is right
  int twin_differs = 0;  ///< of those without a tie
  int cycles_differs = 0;
};

/// Pixels where twin and Cycles differ, then some at outlines, then some anywhere.
std::vector<std::pair<int, int>> pixels_to_ask(const Ids& twin, const Ids& cycles) {
  constexpr std::size_t kDiffering = 60, kOutline = 60, kAnywhere = 20;
  std::vector<std::pair<int, int>> differing, outline, anywhere;
  for (int y = 1; y + 1 < twin.height; ++y) {
    for (int x = 1; x + 1 < twin.width; ++x) {
      const auto id = twin.at(y, x);
      if (id != cycles.at(y, x)) {
        differing.emplace_back(x, y);
      } else if (twin.at(y, x + 1) != id || twin.at(y + 1, x) != id) {
        outline.emplace_back(x, y);
      } else {
        anywhere.emplace_back(x, y);
      }
    }
  }
  std::mt19937 random(1);
  std::vector<std::pair<int, int>> pixels;
  for (auto [from, most] : {std::pair(&differing, kDiffering), std::pair(&outline, kOutline),
                            std::pair(&anywhere, kAnywhere)}) {
    for (std::size_t i = 0; i < most && !from->empty(); ++i) {
      const std::size_t pick = random() % from->size();
      pixels.push_back((*from)[pick]);
      (*from)[pick] = from->back();
      from->pop_back();
    }
  }
  return pixels;
}

void ask_cgal(const FrameSpec& spec, const MeshBuffers& buffers, const Ids& twin, const Ids& cycles,
              ExactTally& tally) {
  const ExactScene exact(spec, buffers);
  for (const auto& [x, y] : pixels_to_ask(twin, cycles)) {
    const ExactHit hit = exact.first_hit(x, y);
    ++tally.asked;
    if (hit.tie) {
      ++tally.ties;
      continue;
    }
    tally.twin_differs += twin.at(y, x) != hit.id ? 1 : 0;
    tally.cycles_differs += cycles.at(y, x) != hit.id ? 1 : 0;
  }
}

std::int64_t differing(const Ids& a, const Ids& b) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) count += a.values[i] != b.values[i] ? 1 : 0;
  return count;
}

void run(const StabilityScenes& scenes, const StabilityCase& each, const fs::path& folder,
         const std::map<std::string, fs::path>& meshes, TwinTracer& tracer) {
  const std::vector<Ids> rendered = Renderer(each, folder, meshes, folder / "scripts").render();
  TwinTally sum;
  ExactTally exact;
  std::int64_t twin_moved = 0;
  std::string complaint;
  for (std::size_t i = 0; i < rendered.size(); ++i) {
    const FrameSpec& spec = each.frames[i];
    const auto twin = tracer.trace(spec, scenes.buffers(), TwinTracer::Passes::kIdsOnly);
    if (!twin) give_up(twin.error().message);
    const TwinVerdict verdict = compare_with_twin(spec, rendered[i], twin->instance_ids, {});
    sum.pixels += verdict.tally.pixels;
    sum.inside_px += verdict.tally.inside_px;
    sum.edge_px += verdict.tally.edge_px;
    if (complaint.empty()) complaint = verdict.complaint;
    ask_cgal(spec, scenes.buffers(), twin->instance_ids, rendered[i], exact);
    const auto at_origin = tracer.trace(scenes.cases().front().frames[i], scenes.buffers(),
                                        TwinTracer::Passes::kIdsOnly);
    twin_moved += differing(twin->instance_ids, at_origin->instance_ids);
  }
  fmt::print("{}\n", canonical_json({{"group", each.group},
                                     {"name", each.name},
                                     {"pixels", sum.pixels},
                                     {"inside_px", sum.inside_px},
                                     {"edge_px", sum.edge_px},
                                     {"refused", !complaint.empty()},
                                     {"from_first_case_px", twin_moved},
                                     {"exact_asked", exact.asked},
                                     {"exact_ties", exact.ties},
                                     {"twin_differs", exact.twin_differs},
                                     {"cycles_differs", exact.cycles_differs}}));
  std::fflush(stdout);
}

}  // namespace
}  // namespace seedframe

int main(int argc, char** argv) {
  using namespace seedframe;
  if (argc != 2) give_up("usage: stability <folder>");
  const fs::path folder = fs::absolute(argv[1]);
  auto library = AssetLibrary::open({fs::path(SEEDFRAME_HOME) / "assets"});
  if (!library) give_up(library.error().message);
  const StabilityScenes scenes(std::move(*library));
  std::map<std::string, fs::path> meshes;
  for (const auto& [sha256, buffer] : scenes.buffers()) {
    meshes[sha256] = folder / (sha256 + ".mesh");
    if (!write_file_unsynced(meshes[sha256], *buffer)) give_up("cannot write " + folder.string());
  }
  TwinTracer tracer;
  for (const StabilityCase& each : scenes.cases()) run(scenes, each, folder, meshes, tracer);
  return 0;
}
