#include "audit/audit_report.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostListed = 20;
constexpr std::array<Grade, 5> kGrades = {Grade::kIdentical, Grade::kRounding, Grade::kTolerance,
                                          Grade::kLabels, Grade::kNotReproducible};

std::string megabytes(std::uint64_t bytes) {
  constexpr double kMega = 1e6;
  return fmt::format("{:.1f} MB", static_cast<double>(bytes) / kMega);
}

template <class Numbers>
std::string list_of(const Numbers& numbers) {
  return fmt::format("{}", fmt::join(numbers, ", "));
}

Json file_check_json(const FileCheck& files) {
  Json problems = Json::array();
  for (const auto& problem : files.problems) {
    problems.push_back({{"frame", problem.frame}, {"text", problem.text}});
  }
  Json duplicates = Json::array();
  for (const auto& group : files.duplicates) {
    duplicates.push_back({{"frames", group.frames}, {"same_spec", group.same_spec}});
  }
  return {{"frames", files.frames},
          {"bytes", files.bytes},
          {"problems", problems},
          {"of_no_frame", files.of_no_frame},
          {"other_inputs", files.other_inputs},
          {"duplicates", duplicates}};
}

Json frame_json(const AuditedFrame& frame) {
  Json json = {{"frame", frame.frame}, {"why", frame.why}, {"grade", to_string(frame.grade)}};
  if (frame.difference) json["difference"] = to_json(*frame.difference);
  if (!frame.error.empty()) json["error"] = frame.error;
  if (!frame.inputs.empty()) json["inputs"] = frame.inputs;
  if (frame.cause.kind != Cause::Kind::kNone) {
    json["cause"] = {{"kind", to_string(frame.cause.kind)}, {"text", frame.cause.text}};
  }
  if (!frame.picture.empty()) json["picture"] = "differences/" + frame.picture.filename().string();
  return json;
}

/// "12 identical, 3 rounding"
std::string count_of_grades(const Audit& audit) {
  std::vector<std::string> parts;
  for (const Grade grade : kGrades) {
    if (const auto count = audit.count(grade); count > 0) {
      parts.push_back(fmt::format("{} {}", count, to_string(grade)));
    }
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Each problem of a frame is told, but a frame counts once.
std::size_t frames_with_problems(const FileCheck& files) {
  std::set<std::int64_t> frames;
  for (const FileCheck::Problem& problem : files.problems) frames.insert(problem.frame);
  return frames.size();
}

std::vector<std::string> file_lines(const FileCheck& files) {
  std::vector<std::string> lines = {fmt::format(
      "files: {} frames with {} were read, {}", files.frames, megabytes(files.bytes),
      files.problems.empty()
          ? "all as they were written"
          : fmt::format("{} are not as they were written", frames_with_problems(files)))};
  for (std::size_t i = 0; i < std::min(kMostListed, files.of_no_frame.size()); ++i) {
    lines.push_back("  " + files.of_no_frame[i]);
  }
  if (files.of_no_frame.size() > kMostListed) {
    lines.push_back(fmt::format("  and {} more of no frame: report.json lists them",
                                files.of_no_frame.size() - kMostListed));
  }
  for (std::size_t i = 0; i < std::min(kMostListed, files.problems.size()); ++i) {
    lines.push_back(fmt::format("  frame {}: {}", files.problems[i].frame, files.problems[i].text));
  }
  if (files.problems.size() > kMostListed) {
    lines.push_back(
        fmt::format("  and {} more: report.json lists them", files.problems.size() - kMostListed));
  }
  if (!files.other_inputs.empty()) {
    const std::size_t listed = std::min(kMostListed, files.other_inputs.size());
    const std::vector<std::int64_t> first(
        files.other_inputs.begin(),
        files.other_inputs.begin() + static_cast<std::ptrdiff_t>(listed));
    lines.push_back(fmt::format("inputs: of {} frames something else is asked today: {}{}",
                                files.other_inputs.size(), list_of(first),
                                listed < files.other_inputs.size() ? ", …" : ""));
  }
  for (std::size_t i = 0; i < std::min(kMostListed, files.duplicates.size()); ++i) {
    const FileCheck::Duplicates& group = files.duplicates[i];
    lines.push_back(fmt::format("duplicates: frames {} have the same pixels{}",
                                list_of(group.frames),
                                group.same_spec ? ", and the same was asked for" : ""));
  }
  if (files.duplicates.size() > kMostListed) {
    lines.push_back(fmt::format("  and {} more groups of duplicates: report.json lists them",
                                files.duplicates.size() - kMostListed));
  }
  return lines;
}

std::vector<std::string> export_lines(const std::vector<AuditedExport>& exports) {
  std::vector<std::string> lines;
  for (const AuditedExport& each : exports) {
    lines.push_back(
        fmt::format("export {}: {}", each.format,
                    each.first_differences.empty()
                        ? fmt::format("{} frames are what their source says", each.frames)
                        : fmt::format("not what its source says, in {} places", each.differences)));
    for (const std::string& difference : each.first_differences) lines.push_back("  " + difference);
  }
  return lines;
}

std::string describe_frame(const AuditedFrame& frame) {
  std::string text = fmt::format("frame {}: {}", frame.frame, to_string(frame.grade));
  if (frame.cause.kind != Cause::Kind::kNone)
    text += fmt::format("\n  cause: {}", frame.cause.text);
  if (frame.difference) text += fmt::format("\n  {}", describe(*frame.difference));
  for (const std::string& input : frame.inputs) text += "\n  asked for otherwise: " + input;
  return text;
}

}  // namespace

Json to_json(const Audit& audit, const std::vector<AuditedExport>& exports) {
  Json failed = Json::array();
  for (const FrameRow& row : audit.sample.failed) {
    failed.push_back({{"frame", row.frame}, {"state", to_string(row.state)}, {"error", row.error}});
  }
  Json rounds = Json::array();
  for (const Conditions& round : audit.rounds) {
    Json names = Json::array();
    for (const Condition condition : round) names.push_back(to_string(condition));
    rounds.push_back(std::move(names));
  }
  Json frames = Json::array();
  for (const AuditedFrame& frame : audit.frames) frames.push_back(frame_json(frame));
  Json exported = Json::array();
  for (const AuditedExport& each : exports) {
    exported.push_back({{"format", each.format},
                        {"frames", each.frames},
                        {"differences", each.differences},
                        {"first_differences", each.first_differences}});
  }
  Json grades = Json::object();
  for (const Grade grade : kGrades) grades[to_string(grade)] = audit.count(grade);
  return {{"version", 1},
          {"campaign_frames", audit.sample.total},
          {"done", audit.sample.done},
          {"failed", failed},
          {"files", file_check_json(audit.files)},
          {"exports", exported},
          {"rounds", rounds},
          {"frames", frames},
          {"grades", grades},
          {"grade", to_string(audit.grade())}};
}

std::string audit_summary(const Audit& audit, const std::vector<AuditedExport>& exports) {
  std::vector<std::string> lines = file_lines(audit.files);
  if (!audit.why_alone.empty()) {
    lines.push_back(
        "note: the config cannot be read here, so labels, frame ids and what frames were made from "
        "are not made again: " +
        audit.why_alone.substr(0, audit.why_alone.find('\n')));
  }
  for (std::string& line : export_lines(exports)) lines.push_back(std::move(line));
  for (std::size_t i = 0; i < std::min(kMostListed, audit.sample.failed.size()); ++i) {
    const FrameRow& row = audit.sample.failed[i];
    lines.push_back(fmt::format("frame {} is {}: {}", row.frame, to_string(row.state),
                                row.error.substr(0, row.error.find('\n'))));
  }
  for (std::size_t i = 0; i < audit.rounds.size(); ++i) {
    lines.push_back(fmt::format("round {}: {} frames rendered again, varying {}", i + 1,
                                audit.frames.size(), describe(audit.rounds[i])));
  }
  std::size_t listed = 0;
  for (const AuditedFrame& frame : audit.frames) {
    if (frame.grade == Grade::kIdentical || listed++ >= kMostListed) continue;
    lines.push_back(describe_frame(frame));
  }
  if (listed > kMostListed) {
    lines.push_back(
        fmt::format("and {} frames more: report.json lists them", listed - kMostListed));
  }
  if (!audit.rounds.empty()) {
    lines.push_back(fmt::format("{} of {} frames were audited: {}", audit.frames.size(),
                                audit.sample.done, count_of_grades(audit)));
  }
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

std::string audit_markdown(const std::string& title, const Audit& audit,
                           const std::vector<AuditedExport>& exports) {
  std::string text = fmt::format("# Audit of {}\n\n", title);
  for (const std::string& line : file_lines(audit.files)) text += fmt::format("- {}\n", line);
  for (const std::string& line : export_lines(exports)) text += fmt::format("- {}\n", line);
  if (!audit.rounds.empty()) {
    text += fmt::format("\n{} of {} frames were rendered again: **{}**. Varied were\n\n",
                        audit.frames.size(), audit.sample.done, count_of_grades(audit));
    for (std::size_t i = 0; i < audit.rounds.size(); ++i) {
      text += fmt::format("{}. {}\n", i + 1, describe(audit.rounds[i]));
    }
    text += "\n| frame | why it is here | grade | cause | what differs |\n|---:|---|---|---|---|\n";
  }
  for (const AuditedFrame& frame : audit.frames) {
    text +=
        fmt::format("| {} | {} | {} | {} | {} |\n", frame.frame, frame.why, to_string(frame.grade),
                    frame.cause.text, frame.difference ? describe(*frame.difference) : "");
  }
  for (const AuditedFrame& frame : audit.frames) {
    if (frame.picture.empty()) continue;
    text += fmt::format("\n![Frame {}: where it differs](differences/{})\n", frame.frame,
                        frame.picture.filename().string());
  }
  return text;
}

Status take_audit_folder(const fs::path& folder) {
  std::error_code error;
  const bool is_new = !fs::exists(folder, error);
  const bool is_audit = fs::exists(folder / "report.json", error);
  if (!is_new && !is_audit && !fs::is_empty(folder, error)) {
    return fail(ErrorKind::kInput, "{} is neither empty nor an audit: give another folder with -o",
                folder.string());
  }
  fs::remove_all(folder, error);
  if (Status made = make_folders(folder); !made) {
    return tl::unexpected(
        Error{made.error().kind, made.error().message + ": -o names another place for the report"});
  }
  return write_file(folder / "report.json", "{}\n");  // an audit that did not end
}

Status write_audit_report(const fs::path& folder, const std::string& title, const Audit& audit,
                          const std::vector<AuditedExport>& exports) {
  for (const auto& [name, text] :
       {std::pair("report.md", audit_markdown(title, audit, exports)),
        std::pair("report.json", readable_json(to_json(audit, exports)))}) {
    if (Status written = write_file_atomically(folder / name, text); !written) return written;
  }
  return {};
}

}  // namespace seedframe
