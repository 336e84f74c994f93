#include "study/study_run.h"

#include "base/files.h"

namespace seedframe {
namespace {

Result<std::vector<StudyRow>> measure_all(
    Study& study, const std::vector<StudyCondition>& conditions,
    const std::function<void(const std::string&)>& on_condition) {
  std::vector<StudyRow> rows;
  rows.reserve(conditions.size());
  for (const StudyCondition& condition : conditions) {
    on_condition(condition.name);
    Result<StudyRow> row = study.measure(condition);
    if (!row) return forward_error(row);
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace

Result<StudyResult> run_study(Study& study, int most_samples,
                              const std::function<void(const std::string&)>& on_condition) {
  StudyResult result;
  auto conditions = measure_all(study, study_conditions(), on_condition);
  if (!conditions) return forward_error(conditions);
  result.conditions = std::move(*conditions);
  // The last condition chose its kernels: ask once more.
  if (auto plain = study.measure({"", {}, {}, 1}); !plain) return forward_error(plain);
  Result<std::string> made_with = study.made_with();
  if (!made_with) return forward_error(made_with);
  result.made_with = std::move(*made_with);
  auto samples = measure_all(study, sample_conditions(most_samples), on_condition);
  if (!samples) return forward_error(samples);
  result.samples = std::move(*samples);
  return result;
}

Status write_study(const StudyResult& result, const std::filesystem::path& folder) {
  for (const auto& [name, text] :
       {std::pair("study.md", study_markdown(result)), std::pair("study.svg", study_plot(result)),
        std::pair("study.json", readable_json(to_json(result)))}) {
    if (Status written = write_file_atomically(folder / name, text); !written) return written;
  }
  return {};
}

}  // namespace seedframe
