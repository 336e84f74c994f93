#include "audit/audit.h"

#include <algorithm>

#include "audit/json_difference.h"
#include "base/files.h"
#include "image/png_file.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostInputDifferences = 8;
constexpr int kCompanions = 8;

Conditions without(Conditions conditions, const Conditions& others) {
  for (const Condition condition : others) conditions.erase(condition);
  return conditions;
}

bool is_unexplained(const AuditedFrame& frame) {
  return frame.grade != Grade::kIdentical && frame.cause.kind == Cause::Kind::kNone;
}

bool is_portable(const PreparedCampaign& prepared) {
  return prepared.settings.determinism.mode == Determinism::Mode::kPortable;
}

/// Frames to render before or beside others: the first ones of the campaign.
Result<std::vector<std::int64_t>> companions_of(const JobStore& store) {
  const auto rows = store.frames_in(FrameState::kDone, kCompanions);
  if (!rows) return forward_error(rows);
  std::vector<std::int64_t> frames;
  frames.reserve(rows->size());
  for (const FrameRow& row : *rows) frames.push_back(row.frame);
  return frames;
}

}  // namespace

std::int64_t Audit::count(Grade grade) const {
  return std::count_if(frames.begin(), frames.end(),
                       [&](const AuditedFrame& frame) { return frame.grade == grade; });
}

Grade Audit::grade() const {
  const bool as_asked = sample.failed.empty() && files.other_inputs.empty();
  Grade worst = as_asked ? Grade::kIdentical : Grade::kNotReproducible;
  for (const AuditedFrame& frame : frames) worst = std::max(worst, frame.grade);
  return worst;
}

Auditor::Auditor(const Campaign& campaign, PreparedCampaign& prepared, const RunSetup& setup,
                 const AuditOptions& options)
    : campaign_(campaign),
      prepared_(prepared),
      setup_(setup),
      options_(options),
      portable_(is_portable(prepared)) {}

Status Auditor::look() {
  Result<FileCheck> files = check_files(campaign_, {prepared_.settings.categories, &prepared_});
  if (!files) return forward_error(files);
  audit_.files = std::move(*files);
  Result<AuditSample> sample = choose_sample(campaign_.store, options_.sample);
  if (!sample) return forward_error(sample);
  audit_.sample = std::move(*sample);
  for (const SampledFrame& sampled : audit_.sample.frames) {
    AuditedFrame& frame = audit_.frames.emplace_back();
    frame.frame = sampled.row.frame;
    frame.why = sampled.why;
    for (const FileCheck::Problem& problem : audit_.files.problems) {
      if (problem.frame != frame.frame) continue;
      frame.grade = Grade::kNotReproducible;
      frame.cause = {Cause::Kind::kFiles, problem.text};
    }
    if (Status compared = compare_inputs(frame); !compared) return compared;
  }
  if (audit_.frames.empty()) return {};
  audit_.rounds = rounds();
  auto companions = companions_of(campaign_.store);
  if (!companions) return forward_error(companions);
  companions_ = std::move(*companions);
  const Result<MadeWith> made = made_with(campaign_.store, audit_.frames.front().frame);
  if (!made) return forward_error(made);
  threads_ = made->threads;
  return {};
}

/// What excludes each other, or is promised only by some modes, goes into rounds of its own.
std::vector<Conditions> Auditor::rounds() const {
  const Conditions& vary = options_.vary;
  Conditions together = without(vary, {Condition::kFreshWorker, Condition::kNode});
  if (!portable_) together.erase(Condition::kIsa);
  std::vector<Conditions> rounds;
  const bool only_nodes = vary == Conditions{Condition::kNode};
  if ((!together.empty() || vary.empty()) && !only_nodes) rounds.push_back(together);
  if (vary.contains(Condition::kFreshWorker)) {
    Conditions fresh = without(together, {Condition::kHistory, Condition::kOrder});
    fresh.insert(Condition::kFreshWorker);
    rounds.push_back(std::move(fresh));
  }
  if (vary.contains(Condition::kIsa) && !portable_) rounds.push_back({Condition::kIsa});
  if (vary.contains(Condition::kNode)) rounds.push_back({Condition::kNode});
  return rounds;
}

RunOptions Auditor::options_of(const Conditions& varied) const {
  RunOptions options = setup_.options;
  options.worker.threads = threads_;
  return vary(std::move(options), varied, portable_, options_.folder / kElsewhere);
}

Arrangement Auditor::arrangement_of(const Conditions& varied) const {
  std::vector<std::int64_t> frames;
  frames.reserve(audit_.frames.size());
  for (const AuditedFrame& frame : audit_.frames) frames.push_back(frame.frame);
  return arrange(std::move(frames), varied, companions_, options_of(varied).pool.workers);
}

std::int64_t Auditor::renderings() const {
  std::size_t count = 0;
  for (const Conditions& round : audit_.rounds) count += arrangement_of(round).frames.size();
  return static_cast<std::int64_t>(count);
}

Status Auditor::compare_inputs(AuditedFrame& frame) {
  const Result<ExpandedFrame> expanded = prepared_.expander.expand(frame.frame);
  if (!expanded) return forward_error(expanded);
  const auto row = campaign_.store.frame(frame.frame);
  if (!row) return forward_error(row);
  if (!*row || (*row)->frame_id == expanded->id) return {};
  const fs::path path = campaign_.files.frame(frame.frame) / frame_files::kSpec;
  const Result<std::string> text = read_file(path);
  const Result<Json> stored =
      text ? parse_json(*text, path.string()) : Result<Json>(forward_error(text));
  if (stored) {
    frame.inputs = json_differences(*stored, to_json(expanded->spec), kMostInputDifferences);
  }
  frame.grade = Grade::kNotReproducible;
  if (frame.cause.kind == Cause::Kind::kNone) {
    frame.cause = cause_of_inputs(campaign_, prepared_, expanded->used, frame.inputs);
  }
  return {};
}

Status Auditor::render(RunObserver& observer) {
  Rerenderer rerenderer(prepared_, setup_, observer, options_.on_other_nodes);
  for (std::size_t i = 0; i < audit_.rounds.size(); ++i) {
    Status rendered = render_round(audit_.rounds[i], i + 1, rerenderer);
    if (!rendered) return rendered;
  }
  return {};
}

Status Auditor::render_round(const Conditions& varied, std::size_t number, Rerenderer& rerenderer) {
  const Result<Campaign> rendered =
      rerenderer.render(arrangement_of(varied), options_of(varied),
                        options_.folder / fmt::format("round-{}", number));
  if (!rendered) return forward_error(rendered);
  for (AuditedFrame& frame : audit_.frames) {
    const Grade before = frame.grade;
    const bool had_difference = frame.difference.has_value();
    if (Status judged = judge(*rendered, frame); !judged) return judged;
    if (frame.grade == before && frame.difference.has_value() == had_difference) continue;
    const Result<MadeWith> made = made_with(rendered->store, frame.frame);
    if (!made) return forward_error(made);
    departures_.try_emplace(frame.frame, Departure{varied, made->provenance});
  }
  return {};
}

/// Keeps the worst that happened to a frame.
Status Auditor::judge(const Campaign& rendered, AuditedFrame& frame) {
  const auto row = rendered.store.frame(frame.frame);
  if (!row) return forward_error(row);
  if (!*row || (*row)->state != FrameState::kDone) {
    frame.grade = Grade::kNotReproducible;
    frame.error = *row ? (*row)->error : "it was not rendered";
    if (frame.cause.kind == Cause::Kind::kNone) {
      frame.cause = {Cause::Kind::kNotRendered, frame.error.substr(0, frame.error.find('\n'))};
    }
    return {};
  }
  if (frame.cause.kind == Cause::Kind::kFiles) return {};  // there is nothing to compare with
  const fs::path expected = campaign_.files.frame(frame.frame);
  const fs::path found = rendered.files.frame(frame.frame);
  const Result<Manifest> x = read_manifest(expected);
  if (!x) return forward_error(x);
  const Result<Manifest> y = read_manifest(found);
  if (!y) return forward_error(y);
  Result<FrameDifference> difference =
      difference_of_frames(expected, *x, found, *y, options_.tolerance);
  if (!difference) return forward_error(difference);
  const bool changed_inputs = frame.cause.kind == Cause::Kind::kInputs;
  const bool worse =
      difference->grade > (frame.difference ? frame.difference->grade : Grade::kIdentical);
  if (!worse) return {};
  if (!changed_inputs) frame.grade = std::max(frame.grade, difference->grade);
  frame.difference = std::move(*difference);
  const auto map = heat_map_of_frames(expected, found);
  if (!map) return map.error().kind == ErrorKind::kInput ? Status() : forward_error(map);
  const fs::path folder = options_.folder / "differences";
  if (Status made = make_folders(folder); !made) return made;
  frame.picture = folder / (frame_stem(frame.frame) + ".png");
  return write_file_atomically(frame.picture, encode_png(*map));
}

std::int64_t Auditor::unexplained() const {
  return std::count_if(audit_.frames.begin(), audit_.frames.end(), is_unexplained);
}

Status Auditor::explain(RunObserver& observer) {
  const fs::path scratch = options_.folder / "work";
  Rerenderer rerenderer(prepared_, setup_, observer, options_.on_other_nodes);
  CauseFinder finder(campaign_, rerenderer, setup_.options, portable_, companions_, scratch);
  const AuditedFrame* example = nullptr;  // the last one whose cause was looked for
  int looked_for = 0;
  for (AuditedFrame& frame : audit_.frames) {
    if (!is_unexplained(frame)) continue;
    if (looked_for == options_.most_causes) {
      if (example == nullptr) continue;
      frame.cause = {example->cause.kind,
                     fmt::format("not looked for; probably as of frame {}", example->frame)};
      continue;
    }
    ++looked_for;
    const auto row = campaign_.store.frame(frame.frame);
    if (!row) return forward_error(row);
    const Departure& departure = departures_.at(frame.frame);
    Result<Cause> cause = finder.find(frame.frame, *row ? (*row)->pixel_hash : std::string(),
                                      departure.round, departure.provenance);
    if (!cause) return forward_error(cause);
    frame.cause = std::move(*cause);
    example = &frame;
  }
  std::error_code ignored;
  fs::remove_all(scratch, ignored);
  return {};
}

}  // namespace seedframe
