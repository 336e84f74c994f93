// What an audit varies on purpose when it renders frames again.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "base/error.h"
#include "spec/campaign_settings.h"

namespace seedframe {

enum class Condition {
  kThreads,      ///< another number of threads in each worker
  kWorkers,      ///< several workers at once
  kOrder,        ///< the last frame first
  kFreshWorker,  ///< a new worker for each frame
  kHistory,      ///< workers that have rendered other frames before
  kTmpdir,       ///< another folder for temporary files, with a space and an umlaut in its name
  kLocale,       ///< a locale with decimal commas
  kTimezone,     ///< one that is 12 h 45 min ahead
  kIsa,          ///< instructions of another CPU
  kNode,         ///< another node of a Slurm cluster than the one that made the frame
};
using Conditions = std::set<Condition>;

const char* to_string(Condition condition);
/// "threads, order"; "nothing" for none.
std::string describe(const Conditions& conditions);

/// All that every mode promises to be without effect: all but kIsa, and kNode, which needs a
/// cluster and is to be asked for by name.
Conditions usual_conditions();
/// All that this mode promises to be without effect.
Conditions promised_conditions(Determinism::Mode mode);
/// "threads,order", or "all" (but for kNode), or "none"; kInput errors name what there is.
Result<Conditions> parse_conditions(std::string_view list);

}  // namespace seedframe
