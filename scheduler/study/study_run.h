// A whole study: all conditions, and some of them at more and more samples.
#pragma once

#include <functional>
#include <string>

#include "study/study.h"
#include "study/study_report.h"

namespace seedframe {

/// `on_condition` is told the name of each before it is measured. The result lacks the size of the
/// pictures, which only who made the study knows.
Result<StudyResult> run_study(Study& study, int most_samples,
                              const std::function<void(const std::string&)>& on_condition);

/// Writes study.md, study.svg and study.json.
Status write_study(const StudyResult& result, const std::filesystem::path& folder);

}  // namespace seedframe
