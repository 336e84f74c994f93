#include "audit/cause.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "audit/culprit.h"
#include "base/files.h"
#include "base/sha256.h"
#include "campaign/input_files.h"
#include "campaign/provenance.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

using CauseKind = Cause::Kind;

constexpr std::size_t kMostInputs = 4;
constexpr std::array<Isa, 5> kIsas = {Isa::kSse2, Isa::kSse41, Isa::kSse42, Isa::kAvx, Isa::kAvx2};

std::string short_hash(const std::string& hash) { return hash.substr(0, 12); }

/// Files of a table of provenance.json whose content is another one now.
void add_changed(const Json& before, const char* table, const char* what,
                 const std::map<std::string, std::string>& now, std::vector<std::string>& changed) {
  if (!before.contains(table)) return;
  for (const auto& [name, hash] : now) {
    const std::string then = before[table].value(name, "");
    if (then.empty() || then == hash) continue;
    changed.push_back(fmt::format("{} {} has changed (SHA-256 {}… instead of {}…)", what, name,
                                  short_hash(hash), short_hash(then)));
  }
}

Kernels kernels_in(const Json& provenance) {
  return {provenance.value("kernel", ""), provenance.value("embree", "")};
}

std::string describe(const Kernels& kernels) {
  return fmt::format("Cycles' kernel {} and Embree's {}", kernels.cycles, kernels.embree);
}

bool are_history(const Conditions& culprits) {
  return culprits.contains(Condition::kHistory) || culprits.contains(Condition::kOrder);
}

}  // namespace

const char* to_string(CauseKind kind) {
  constexpr std::array<const char*, 11> kKindNames = {
      "none",    "inputs",     "files",    "condition",    "history", "persistent data",
      "kernels", "provenance", "unstable", "not rendered", "unknown"};
  return kKindNames[static_cast<std::size_t>(kind)];
}

Cause cause_of_inputs(const Campaign& campaign, const PreparedCampaign& prepared,
                      const UsedFiles& used, const std::vector<std::string>& spec) {
  std::vector<std::string> changed;
  const Result<std::string> text = read_file(campaign.files.provenance());
  const Json before = text ? Json::parse(*text, nullptr, false) : Json();
  if (before.is_object()) {
    const std::uint64_t seed = before.value("seed", prepared.settings.seed);
    if (seed != prepared.settings.seed) {
      changed.push_back(fmt::format("the seed is {} instead of {}", prepared.settings.seed, seed));
    }
    add_changed(before, "assets", "asset", asset_hashes(used), changed);
    add_changed(before, "textures", "texture", image_hashes(used), changed);
    const std::string config = sha256_hex(prepared.source.text);
    if (changed.empty() && before.value("config_sha256", config) != config) {
      changed.emplace_back("campaign.yaml is not the config that was submitted");
    }
  }
  const auto files = inputs_changed_since(campaign, prepared);
  if (changed.empty() && files) {
    for (const std::string& file : *files) changed.push_back(file + " has changed");
  }
  if (changed.empty() && !spec.empty()) changed.push_back("its frame spec has changed: " + spec[0]);
  if (changed.size() > kMostInputs) changed.resize(kMostInputs);
  return {CauseKind::kInputs, fmt::format("{}", fmt::join(changed, "; "))};
}

CauseFinder::CauseFinder(const Campaign& campaign, Rerenderer& rerenderer, const RunOptions& run,
                         bool portable, std::vector<std::int64_t> companions, fs::path scratch)
    : campaign_(campaign),
      rerenderer_(rerenderer),
      run_(run),
      portable_(portable),
      companions_(std::move(companions)),
      scratch_(std::move(scratch)) {}

Result<Cause> CauseFinder::find(std::int64_t frame, const std::string& expected,
                                const Conditions& varied, const Json& provenance) {
  frame_ = frame;
  expected_ = expected;
  Result<MadeWith> made = made_with(campaign_.store, frame);
  if (!made) return forward_error(made);
  made_ = std::move(*made);
  as_recorded_ = {{}, made_.kernels, made_.persistent_data, {}};
  kernels_here_.reset();
  if (made_.kernels && provenance.contains("embree")) kernels_here_ = kernels_in(provenance);
  const Result<std::string> alone = hash_of(as_recorded_);
  if (!alone && alone.error().kind == ErrorKind::kEnvironment) {
    return Cause{CauseKind::kKernels,
                 fmt::format("it was made with {}, which this machine cannot repeat: {}",
                             made_.kernels ? describe(*made_.kernels) : "unknown kernels",
                             alone.error().message.substr(0, alone.error().message.find('\n')))};
  }
  if (!alone) return forward_error(alone);
  if (*alone == expected_) return bisect(varied, provenance);
  return without_condition(*alone, provenance);
}

Result<std::string> CauseFinder::hash_of(const Trial& trial) {
  RunOptions options = run_;
  WorkerOptions& worker = options.worker;
  options.pool.workers = 1;
  worker.threads = made_.threads;
  worker.conditions.kernels = trial.kernels;
  worker.conditions.persistent_data = trial.persistent_data;
  Conditions varied = trial.varied;
  if (varied.contains(Condition::kIsa) && !portable_) {
    worker.conditions.kernels = kernels_here_;
    varied.erase(Condition::kIsa);
  }
  options = vary(std::move(options), varied, portable_, scratch_ / kElsewhere);
  std::vector<std::int64_t> frames = trial.before;
  std::erase(frames, frame_);
  frames.push_back(frame_);
  // Of one frame alone, the order is what comes before it.
  if (varied.erase(Condition::kOrder) > 0) varied.insert(Condition::kHistory);
  const Result<Campaign> rendered =
      rerenderer_.render(arrange(std::move(frames), varied, companions_, options.pool.workers),
                         options, scratch_ / "trial");
  if (!rendered) return forward_error(rendered);
  const auto row = rendered->store.frame(frame_);
  if (!row) return forward_error(row);
  return *row ? (*row)->pixel_hash : std::string();
}

Result<bool> CauseFinder::is_as_expected(const Trial& trial) {
  const Result<std::string> hash = hash_of(trial);
  if (!hash) return forward_error(hash);
  return *hash == expected_;
}

Result<Cause> CauseFinder::bisect(const Conditions& varied, const Json& provenance) {
  Conditions candidates = varied;
  if (kernels_here_ != made_.kernels) candidates.insert(Condition::kIsa);
  const auto flips = [&](const Conditions& conditions) -> Result<bool> {
    Trial trial = as_recorded_;
    trial.varied = conditions;
    const Result<bool> same = is_as_expected(trial);
    if (!same) return forward_error(same);
    return !*same;
  };
  const Result<bool> all = flips(candidates);
  if (!all) return forward_error(all);
  if (*all) {
    const Result<Conditions> culprits = find_culprits(candidates, flips);
    if (!culprits) return forward_error(culprits);
    return name(*culprits, provenance);
  }
  // Not by a condition. The frames of the sample that its worker rendered before are none.
  const Result<bool> history = flips({Condition::kHistory});
  if (!history) return forward_error(history);
  if (*history) return name({Condition::kHistory}, provenance);
  return Cause{CauseKind::kUnstable,
               "it came out otherwise once, and not again in the same conditions"};
}

Result<Cause> CauseFinder::name(const Conditions& culprits, const Json& provenance) {
  if (culprits == Conditions{Condition::kIsa}) {
    const std::string difference = describe_difference(provenance, made_.provenance);
    return Cause{CauseKind::kKernels, difference.empty()
                                          ? "instructions that the C library was not "
                                            "shown change the picture"
                                          : "it was rendered again with " + difference};
  }
  if (!are_history(culprits)) {
    return Cause{CauseKind::kCondition,
                 fmt::format("the picture changes with {}", seedframe::describe(culprits))};
  }
  if (made_.persistent_data) {
    Trial without = as_recorded_;
    without.persistent_data = false;
    const Result<std::string> alone = hash_of(without);
    if (!alone) return forward_error(alone);
    without.varied = culprits;
    const Result<std::string> after_others = hash_of(without);
    if (!after_others) return forward_error(after_others);
    if (*alone == *after_others) {
      return Cause{
          CauseKind::kPersistentData,
          "persistent data is on, and so the frames that its worker rendered before change "
          "the picture; with it off they do not"};
    }
  }
  return Cause{CauseKind::kHistory, "the frames that its worker renders before change the picture"};
}

/// Alone and in the conditions that were noted it is not what is stored.
Result<Cause> CauseFinder::without_condition(const std::string& alone, const Json& provenance) {
  const Result<std::string> again = hash_of(as_recorded_);
  if (!again) return forward_error(again);
  if (*again != alone) {
    return Cause{CauseKind::kUnstable,
                 "it comes out otherwise from time to time in the same conditions"};
  }
  const char* const remedy = made_.persistent_data ? "persistent data is on: " : "";
  const CauseKind by_history =
      made_.persistent_data ? CauseKind::kPersistentData : CauseKind::kHistory;
  Trial trial = as_recorded_;
  trial.before = made_.before;
  if (!trial.before.empty()) {
    const Result<bool> same = is_as_expected(trial);
    if (!same) return forward_error(same);
    if (*same) {
      return Cause{by_history, fmt::format("{}it comes out as stored only after the {} frames that "
                                           "its worker had rendered before it",
                                           remedy, trial.before.size())};
    }
  }
  if (made_.persistent_data) {
    trial.before.clear();
    trial.varied = {Condition::kHistory};
    const Result<std::string> after_others = hash_of(trial);
    if (!after_others) return forward_error(after_others);
    if (*after_others != alone) {
      return Cause{
          CauseKind::kPersistentData,
          "persistent data is on, and so the frames that its worker rendered before change "
          "the picture; which they were is not known any more"};
    }
  }
  for (const Isa isa : kIsas) {
    trial = as_recorded_;
    trial.kernels = kernels_of(isa);
    if (!made_.kernels || trial.kernels == made_.kernels) continue;
    const Result<bool> same = is_as_expected(trial);
    if (same && *same) {
      return Cause{CauseKind::kKernels,
                   fmt::format("it has the pixels of {}, and was noted as made with {}",
                               describe(*trial.kernels), describe(*made_.kernels))};
    }
  }
  Json found = provenance;
  Json noted = made_.provenance;
  for (const char* key : {"kernel", "embree"}) {
    found.erase(key);
    noted.erase(key);
  }
  if (const std::string difference = describe_difference(found, noted); !difference.empty()) {
    return Cause{CauseKind::kProvenance, "it was rendered again with " + difference};
  }
  return Cause{CauseKind::kUnknown,
               "rendered again in the conditions that were noted it comes out the same each time, "
               "but not as stored: perhaps the stored frame was replaced together with its "
               "manifest"};
}

}  // namespace seedframe
