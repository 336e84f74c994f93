#include "study/study.h"

#include <algorithm>
#include <cmath>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/canonical_json.h"
#include "base/files.h"
#include "render/child_process.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr int kRepetitions = 3;  ///< of conditions whose outcome may be chance
constexpr int kFrame = 3;        ///< the one that is compared
constexpr int kMostId = 3;
constexpr const char* kMadeWith = "made_with.txt";
constexpr const char* kLog = "blender.log";
constexpr auto kLongest = std::chrono::minutes(30);

Json setting_json(const StudySetting& setting) {
  return {{"threads", setting.threads},
          {"samples", setting.samples},
          {"adaptive", setting.adaptive},
          {"persistent_data", setting.persistent_data},
          {"after_frames", setting.after_frames},
          {"reversed", setting.reversed},
          {"one_cpu", setting.one_cpu},
          {"kernels", setting.kernels ? Json{setting.kernels->cycles, setting.kernels->embree}
                                      : Json::array()}};
}

std::string picture_name(std::size_t scene, int frame) {
  return fmt::format("{}-{}.exr", scene, frame);
}

Json plan_of(const StudySetting& setting, const Study::Tools& tools) {
  Json renders = Json::array();
  std::vector<std::size_t> order(study_scenes().size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  if (setting.reversed) std::reverse(order.begin(), order.end());
  for (const std::size_t scene : order) {
    for (int frame = setting.after_frames ? 1 : kFrame; frame <= kFrame; ++frame) {
      renders.push_back({{"scene", study_scenes()[scene]},
                         {"frame", frame},
                         {"samples", setting.samples},
                         {"adaptive", setting.adaptive},
                         {"width", tools.width},
                         {"height", tools.height},
                         {"output", (tools.scratch / picture_name(scene, frame)).string()}});
    }
  }
  return {{"persistent_data", setting.persistent_data},
          {"cpus", setting.one_cpu ? Json(allowed_cpus()) : Json()},
          {"made_with", (tools.scratch / kMadeWith).string()},
          {"renders", renders}};
}

/// False: it has crashed.
Result<bool> run_blender(const StudySetting& setting, const Study::Tools& tools,
                         const fs::path& plan) {
  const fs::path log = tools.scratch / kLog;
  const int output = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (output < 0) return fail(ErrorKind::kEnvironment, "cannot write {}", log.string());
  const auto changes = environment_of({setting.kernels, setting.persistent_data}, tools.preload);
  ChildCommand command;
  command.arguments = blender_command(tools.blender.program, tools.scripts, setting.threads,
                                      tools.scripts / "study/render_study.py");
  command.arguments.push_back(plan.string());
  command.environment = worker_environment({changes.begin(), changes.end()});
  command.output = output;
  if (setting.one_cpu) command.cpu = allowed_cpus().front();
  const Result<pid_t> child = start_child(command);
  ::close(output);
  if (!child) return forward_error(child);
  const auto status = wait_for_child(*child, kLongest);
  if (!status) kill_child(*child);
  if (status == 0) return true;
  if (status && WIFSIGNALED(*status)) return false;
  return fail(ErrorKind::kEnvironment, "Blender {}: its log is {}", describe_wait_status(status),
              log.string());
}

double luma(const Image<float>& image, int row, int column) {
  constexpr std::array<double, 3> kRec709 = {0.2126, 0.7152, 0.0722};
  double sum = 0.0;
  for (int c = 0; c < 3; ++c) {
    sum += kRec709[static_cast<std::size_t>(c)] * double{image.at(row, column, c)};
  }
  return sum;
}

template <class T>
bool same_pixel(const Image<T>& a, const Image<T>& b, int row, int column) {
  for (int c = 0; c < a.channels; ++c) {
    if (a.at(row, column, c) != b.at(row, column, c)) return false;
  }
  return true;
}

void add_darkness(const FramePasses& a, const Image<std::uint8_t>& display_a, const FramePasses& b,
                  const Image<std::uint8_t>& display_b, Darkness& darkness) {
  constexpr int kBin = 64;
  constexpr double kLeastLuma = 1e-4;
  for (int row = 0; row < a.combined.height; ++row) {
    for (int column = 0; column < a.combined.width; ++column) {
      const int code = std::max({display_a.at(row, column, 0), display_a.at(row, column, 1),
                                 display_a.at(row, column, 2)});
      DarknessBin& bin = darkness[static_cast<std::size_t>(code / kBin)];
      ++bin.pixels;
      if (same_pixel(a.combined, b.combined, row, column)) continue;
      ++bin.differing_linear;
      if (!same_pixel(display_a, display_b, row, column)) ++bin.differing_display;
      const double expected = luma(a.combined, row, column);
      const double distance = std::abs(luma(b.combined, row, column) - expected);
      bin.sum_absolute += distance;
      bin.sum_relative += distance / std::max(kLeastLuma, expected);
    }
  }
}

StudySetting with_samples(int samples) {
  StudySetting setting;
  setting.samples = samples;
  return setting;
}

}  // namespace

const std::vector<std::string>& study_scenes() {
  static const std::vector<std::string> scenes = {"diffuse",     "glossy",         "glass",
                                                  "subsurface",  "volumes",        "hair",
                                                  "many lights", "depth of field", "motion blur"};
  return scenes;
}

std::vector<StudyCondition> study_conditions() {
  const StudySetting plain;
  std::vector<StudyCondition> conditions;
  const auto add = [&](const std::string& name, const StudySetting& reference, auto change,
                       int repetitions = 1) {
    StudyCondition condition{name, reference, reference, repetitions};
    change(condition.setting);
    conditions.push_back(std::move(condition));
  };
  add("again, in a fresh process", plain, [](StudySetting&) {});
  add(
      "2 threads", plain, [](StudySetting& s) { s.threads = 2; }, kRepetitions);
  add(
      "4 threads", plain, [](StudySetting& s) { s.threads = 4; }, kRepetitions);
  add("after other frames", plain, [](StudySetting& s) { s.after_frames = true; });
  add("scenes in the other order", plain, [](StudySetting& s) { s.reversed = true; });
  add(
      "2 threads, Blender started on all CPUs", plain,
      [](StudySetting& s) {
        s.threads = 2;
        s.one_cpu = false;
      },
      kRepetitions);
  StudySetting usual;
  usual.threads = 2;
  usual.one_cpu = false;
  add(
      "the same, again", usual, [](StudySetting&) {}, kRepetitions);
  add("persistent data", plain, [](StudySetting& s) { s.persistent_data = true; });
  add("persistent data, after other frames", plain, [](StudySetting& s) {
    s.persistent_data = true;
    s.after_frames = true;
  });
  StudySetting adaptive;
  adaptive.adaptive = true;
  add("adaptive sampling, again", adaptive, [](StudySetting&) {});
  add(
      "adaptive sampling, 2 threads", adaptive, [](StudySetting& s) { s.threads = 2; },
      kRepetitions);
  add("adaptive sampling, after other frames", adaptive,
      [](StudySetting& s) { s.after_frames = true; });
  StudySetting best;
  best.kernels = kernels_of(Isa::kAvx2);
  add("Embree without AVX-512", plain, [&](StudySetting& s) { s.kernels = best.kernels; });
  for (const auto& [name, isa] : {std::pair("AVX", Isa::kAvx), std::pair("SSE4.1", Isa::kSse41),
                                  std::pair("SSE2", Isa::kSse2)}) {
    add(fmt::format("kernels for {} instead of AVX2", name), best,
        [isa = isa](StudySetting& s) { s.kernels = kernels_of(isa); });
  }
  add(
      "kernels for AVX, after other frames with 2 threads",
      [&] {
        StudySetting avx;
        avx.kernels = kernels_of(Isa::kAvx);
        return avx;
      }(),
      [](StudySetting& s) {
        s.threads = 2;
        s.after_frames = true;
      });
  return conditions;
}

std::vector<StudyCondition> sample_conditions(int most) {
  std::vector<StudyCondition> conditions;
  for (int samples = 1; samples <= most; samples *= 4) {
    StudyCondition threads{fmt::format("2 threads, {} samples", samples), with_samples(samples),
                           with_samples(samples), 1};
    threads.setting.threads = 2;
    StudyCondition kernels{fmt::format("kernels for AVX, {} samples", samples),
                           with_samples(samples), with_samples(samples), 1};
    kernels.setting.kernels = kernels_of(Isa::kAvx);
    StudyCondition usual{fmt::format("2 threads, started on all CPUs, {} samples", samples),
                         with_samples(samples), with_samples(samples), kRepetitions};
    usual.setting.threads = 2;
    usual.setting.one_cpu = false;
    conditions.push_back(std::move(threads));
    conditions.push_back(std::move(usual));
    conditions.push_back(std::move(kernels));
  }
  return conditions;
}

Result<StudyRow> Study::measure(const StudyCondition& condition) {
  const auto expected = reference(condition.reference);
  if (!expected) return forward_error(expected);
  StudyRow row{condition, std::vector<StudyCell>(study_scenes().size()), {}};
  for (int repetition = 0; repetition < condition.repetitions; ++repetition) {
    const Result<Pictures> found = render(condition.setting);
    if (!found) return forward_error(found);
    for (std::size_t scene = 0; scene < found->size(); ++scene) {
      const Picture& a = (**expected)[scene];
      const Picture& b = (*found)[scene];
      StudyCell cell;
      cell.linear = difference_of(a.passes.combined, b.passes.combined, StoredAs::kHalf);
      cell.display = difference_of(a.display, b.display);
      cell.other_ids = difference_of(a.passes.instance_ids, b.passes.instance_ids).differing;
      cell.other_depths =
          difference_of(*a.passes.depth, *b.passes.depth, StoredAs::kFloat).differing;
      cell.other_normals =
          difference_of(*a.passes.normal, *b.passes.normal, StoredAs::kFloat).differing;
      const auto weight = [](const StudyCell& each) {
        return each.linear.differing + each.other_ids + each.other_depths + each.other_normals;
      };
      if (repetition == 0 || weight(cell) > weight(row.cells[scene])) row.cells[scene] = cell;
      if (repetition == 0) {
        add_darkness(a.passes, a.display, b.passes, b.display, row.darkness);
      }
    }
  }
  return row;
}

Result<std::string> Study::made_with() const {
  Result<std::string> made_with = read_file(tools_.scratch / kMadeWith);
  if (made_with && crashes_ > 0) {
    *made_with += fmt::format("; Blender crashed {} and was started again",
                              crashes_ == 1 ? "once" : fmt::format("{} times", crashes_));
  }
  return made_with;
}

Result<const Study::Pictures*> Study::reference(const StudySetting& setting) {
  const std::string key = canonical_json(setting_json(setting));
  auto found = references_.find(key);
  if (found == references_.end()) {
    Result<Pictures> rendered = render(setting);
    if (!rendered) return forward_error(rendered);
    found = references_.emplace(key, std::move(*rendered)).first;
  }
  return &found->second;
}

Result<Study::Pictures> Study::render(const StudySetting& setting) {
  if (Status made = make_folders(tools_.scratch); !made) return forward_error(made);
  const fs::path plan = tools_.scratch / "plan.json";
  if (Status written = write_file(plan, plan_of(setting, tools_).dump()); !written) {
    return forward_error(written);
  }
  constexpr int kMostCrashes = 3;  // of one rendering
  for (int crashes = 0;; ++crashes) {
    const Result<bool> done = run_blender(setting, tools_, plan);
    if (!done) return forward_error(done);
    if (*done) break;
    ++crashes_;
    if (crashes + 1 == kMostCrashes) {
      return fail(ErrorKind::kEnvironment, "Blender crashed {} times: its log is {}", kMostCrashes,
                  (tools_.scratch / kLog).string());
    }
  }
  Pictures pictures;
  pictures.reserve(study_scenes().size());
  for (std::size_t scene = 0; scene < study_scenes().size(); ++scene) {
    PassExpectation expected{tools_.width, tools_.height};
    expected.depth = expected.normal = true;
    expected.max_instance_id = kMostId;
    Result<FramePasses> passes =
        read_passes(tools_.scratch / picture_name(scene, kFrame), expected);
    if (!passes) return forward_error(passes);
    Result<Image<std::uint8_t>> display =
        color_.apply(passes->combined, {"sRGB", "Standard", "None", 0.0, 1.0});
    if (!display) return forward_error(display);
    pictures.push_back({std::move(*passes), std::move(*display)});
  }
  return pictures;
}

}  // namespace seedframe
