// Renders cases with each Blender, traces them with the twin, and compares both with exact
// arithmetic. Prints one line of JSON a case, of which stability.py makes figures.json; or draws
// the chart of that.
//
//   stability measure <folder for scratch files> <part of an axis's name> <Blender>…
//   stability draw <figures.json> <chart.svg or .png>…
//
// Only axes whose name contains that part are measured; nothing is part of all.

#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

#include "base/files.h"
#include "tests/stability/case_renderer.h"
#include "tests/stability/cases.h"
#include "tests/stability/figures.h"
#include "tests/stability/stability_chart.h"
#include "twin/twin.h"
#include "twin/twin_comparison.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void give_up(const std::string& why) {
  std::fprintf(stderr, "stability: %s\n", why.c_str());
  std::exit(1);
}

template <class T>
T value_of(Result<T> result) {
  if (!result) give_up(result.error().message);
  return std::move(*result);
}

std::int64_t differing(const Image<std::uint16_t>& a, const Image<std::uint16_t>& b) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) count += a.values[i] != b.values[i] ? 1 : 0;
  return count;
}

void add_rendered(const RenderedFrame& rendered, const FrameSpec& spec, const ExactImage& exact,
                  const Twin& twin, BlenderFigures& figures, Agreement& agreement) {
  if (!rendered.failure.empty()) {
    figures.failure = rendered.failure;
    return;
  }
  const FrameImages images = value_of(read_rendered(rendered, spec));
  const TwinVerdict verdict =
      compare_with_twin(spec, images.ids, twin.instance_ids, {}, rounding_of(twin));
  figures.inside_px += verdict.tally.inside_px;
  figures.edge_px += verdict.tally.edge_px;
  if (figures.complaint.empty()) figures.complaint = verdict.complaint;
  figures.judgement.add(exact, twin.instance_ids, images.ids);
  agreement.add(exact, images);
}

class Measurement {
 public:
  Measurement(const StabilityScenes& scenes, const std::vector<CaseRendering>& renderings)
      : scenes_(scenes), renderings_(renderings) {}

  CaseFigures measure(std::size_t index) {
    const StabilityCase& each = scenes_.cases()[index];
    CaseFigures figures{each.axis, each.name, each.at, each.frames.size(), 0, 0, {}, {}};
    for (const CaseRendering& rendering : renderings_) {
      figures.blenders.emplace_back().version = rendering.blender;
    }
    ExactTracer exact_tracer(scenes_.buffers());
    Agreement of_twin;
    std::vector<Agreement> of_blenders(renderings_.size());
    for (std::size_t f = 0; f < each.frames.size(); ++f) {
      const FrameSpec& spec = each.frames[f];
      const Twin twin =
          value_of(tracer_.trace(spec, scenes_.buffers(), TwinTracer::Passes::kAsked));
      const ExactImage exact = exact_tracer.trace(spec);
      figures.asked += exact.asked;
      of_twin.add(exact, {twin.instance_ids, *twin.depth, *twin.normal});
      if (index == 0) first_ids_.push_back(twin.instance_ids);
      if (f < first_ids_.size()) {
        figures.twin_moved += differing(twin.instance_ids, first_ids_[f]);
      }
      for (std::size_t b = 0; b < renderings_.size(); ++b) {
        add_rendered(renderings_[b].frames[index][f], spec, exact, twin, figures.blenders[b],
                     of_blenders[b]);
      }
    }
    figures.twin = figures_of(of_twin);
    for (std::size_t b = 0; b < of_blenders.size(); ++b) {
      figures.blenders[b].agreement = figures_of(of_blenders[b]);
    }
    return figures;
  }

 private:
  const StabilityScenes& scenes_;
  const std::vector<CaseRendering>& renderings_;
  TwinTracer tracer_;
  std::vector<Image<std::uint16_t>> first_ids_;  ///< of the first case, by frame
};

void measure(const fs::path& folder, const std::string& only,
             const std::vector<std::string>& blenders) {
  const StabilityScenes scenes(value_of(AssetLibrary::open({fs::path(SEEDFRAME_HOME) / "assets"})),
                               only);
  std::map<std::string, fs::path> meshes;
  for (const auto& [sha256, buffer] : scenes.buffers()) {
    meshes[sha256] = folder / (sha256 + ".mesh");
    if (!write_file_unsynced(meshes[sha256], *buffer)) give_up("cannot write " + folder.string());
  }
  std::vector<CaseRendering> renderings;
  for (const std::string& blender : blenders) {
    const fs::path scratch = folder / std::to_string(renderings.size());
    fs::create_directories(scratch);
    renderings.push_back(
        value_of(render_cases(scenes.cases(), blender, {folder / "scripts", scratch, meshes})));
  }
  Measurement measurement(scenes, renderings);
  for (std::size_t i = 0; i < scenes.cases().size(); ++i) {
    fmt::print("{}\n", to_json(measurement.measure(i)).dump());
    std::fflush(stdout);
  }
}

void draw(const fs::path& figures, const std::vector<std::string>& charts) {
  const Json json = value_of(parse_json(value_of(read_file(figures)), figures.string()));
  std::vector<CaseFigures> cases;
  for (const Json& each : json.at("cases")) cases.push_back(case_figures_from_json(each));
  for (const std::string& chart : charts) {
    if (const Status drawn = write_stability_chart(cases, chart); !drawn) {
      give_up(drawn.error().message);
    }
  }
}

}  // namespace
}  // namespace seedframe

int main(int argc, char** argv) {
  using namespace seedframe;
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() >= 3 && words[0] == "measure") {
    measure(fs::absolute(words[1]), words[2], {words.begin() + 3, words.end()});
  } else if (words.size() >= 3 && words[0] == "draw") {
    draw(words[1], {words.begin() + 2, words.end()});
  } else {
    give_up(
        "usage: stability measure <folder> <axis> <Blender>... | draw <figures.json> <chart>...");
  }
  return 0;
}
