#include "slurm/slurm_options.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace seedframe {
namespace {

/// The numbers between colons; none if there is anything else.
std::vector<std::int64_t> numbers_in(std::string_view text) {
  std::vector<std::int64_t> numbers;
  while (true) {
    const std::size_t end = std::min(text.find(':'), text.size());
    std::int64_t number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + end, number);
    constexpr std::int64_t kMost = 1'000'000;
    if (error != std::errc() || stop != text.data() + end || number < 0 || number > kMost) {
      return {};
    }
    numbers.push_back(number);
    if (end == text.size()) return numbers;
    text.remove_prefix(end + 1);
  }
}

constexpr std::int64_t kMinute = 60;
constexpr std::int64_t kHour = 3600;
constexpr std::int64_t kDay = 86400;

/// Seconds; 0 if it is no time.
std::int64_t seconds_of(std::string_view text) {
  const std::size_t dash = text.find('-');
  if (dash != std::string_view::npos) {
    const std::vector<std::int64_t> days = numbers_in(text.substr(0, dash));
    std::vector<std::int64_t> rest = numbers_in(text.substr(dash + 1));
    if (days.size() != 1 || rest.empty() || rest.size() > 3) return 0;
    rest.resize(3);
    return days[0] * kDay + rest[0] * kHour + rest[1] * kMinute + rest[2];
  }
  const std::vector<std::int64_t> parts = numbers_in(text);
  switch (parts.size()) {
    case 1:
      return parts[0] * kMinute;
    case 2:
      return parts[0] * kMinute + parts[1];
    case 3:
      return parts[0] * kHour + parts[1] * kMinute + parts[2];
    default:
      return 0;
  }
}

}  // namespace

Json to_json(const SlurmOptions& options) {
  return {{"partition", options.partition}, {"nodes", options.nodes},
          {"time_s", options.time_s},       {"cpus", options.cpus},
          {"more", options.more},           {"batch_frames", options.batch_frames},
          {"poll_s", options.poll_s},       {"node_folder", options.node_folder.string()}};
}

Result<SlurmOptions> slurm_options_from_json(const Json& json, const std::string& what) {
  try {
    SlurmOptions options;
    options.partition = json.at("partition").get<std::string>();
    options.nodes = integer_of<int>(json.at("nodes"));
    options.time_s = integer_of<std::int64_t>(json.at("time_s"));
    options.cpus = integer_of<int>(json.at("cpus"));
    options.more = json.at("more").get<std::vector<std::string>>();
    options.batch_frames = integer_of<int>(json.at("batch_frames"));
    options.poll_s = json.at("poll_s").get<double>();
    options.node_folder = json.at("node_folder").get<std::string>();
    return options;
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{}: not the options of a run by Slurm: {}", what,
                error.what());
  }
}

Result<std::int64_t> read_slurm_time(const std::string& text) {
  const std::int64_t seconds = seconds_of(text);
  if (seconds > 0) return seconds;
  return fail(ErrorKind::kInput,
              "'{}' is not a time as Slurm takes it: expected minutes, hours:minutes:seconds or "
              "days-hours:minutes, such as 90, 1:30:00 or 2-12:00",
              text);
}

std::string slurm_time(double seconds) {
  const auto minutes = static_cast<std::int64_t>(std::ceil(seconds / 60.0));
  return fmt::format("{}:{:02}:00", minutes / 60, minutes % 60);
}

}  // namespace seedframe
