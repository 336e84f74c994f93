#include "page/draw_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "page/packed.h"

namespace seedframe {
namespace {

constexpr std::size_t kMostValues = 40;  // that have a bar each
constexpr std::size_t kMostBins = 32;
constexpr std::size_t kFewestBins = 8;

/// "objects.bolts.count/3" without its copy.
std::string without_copy(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  if (slash == std::string::npos || slash + 1 == name.size()) return name;
  const bool digits = std::all_of(name.begin() + static_cast<std::ptrdiff_t>(slash) + 1, name.end(),
                                  [](char c) { return c >= '0' && c <= '9'; });
  return digits ? name.substr(0, slash) : name;
}

/// All that tells two laws apart.
std::string key_of(const DrawLaw& law) {
  std::string key;
  for (const double parameter : law.parameters) key += fmt::format("{} ", parameter);
  for (const double number : law.numbers) key += fmt::format("{} ", number);
  key += '|';
  for (const double weight : law.weights) key += fmt::format("{} ", weight);
  for (const std::string& name : law.names) key += name + '\n';
  return key;
}

double all_of(const std::vector<double>& weights) {
  double sum = 0.0;
  for (const double weight : weights) sum += weight;
  return sum;
}

/// "uniform, 0 to 360", where every draw follows the same law.
std::string words_of(const DrawLaw& law) {
  const auto& p = law.parameters;
  switch (law.kind) {
    case DistributionKind::kUniform:
    case DistributionKind::kInteger:
      return fmt::format("{} from {:.6g} to {:.6g}",
                         law.kind == DistributionKind::kUniform ? "uniform" : "integer", p[0],
                         p[1]);
    case DistributionKind::kLogUniform:
      return fmt::format("log-uniform from {:.6g} to {:.6g}", p[0], p[1]);
    case DistributionKind::kNormal:
      return fmt::format("normal, mean {:.6g}, std {:.6g}", p[0], p[1]);
    case DistributionKind::kTruncatedNormal:
      return fmt::format("normal, mean {:.6g}, std {:.6g}, from {:.6g} to {:.6g}", p[0], p[1], p[2],
                         p[3]);
    case DistributionKind::kBoundedNormal:
      return fmt::format("normal from {:.6g} to {:.6g}, mean {:.6g} and std {:.6g} there", p[2],
                         p[3], p[0], p[1]);
    case DistributionKind::kPoisson:
      return fmt::format("Poisson, mean {:.6g}", p[0]);
    case DistributionKind::kChoice:
      return law.names.empty() && law.numbers.empty() ? "a mixture" : "weighted choice";
    case DistributionKind::kEmpirical:
      return "samples of a file";
  }
  return {};
}

const char* name_of(Level level) {
  switch (level) {
    case Level::kCampaign:
      return "campaign";
    case Level::kScene:
      return "scene";
    case Level::kFrame:
      return "frame";
  }
  return "";
}

/// Of the smallest to the largest that is drawn or, where the law has an end, could be.
struct Range {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();

  void take(double x) {
    if (!std::isfinite(x)) return;
    least = std::min(least, x);
    most = std::max(most, x);
  }
};

/// What the law can give: its ends, and where they are few its values.
void take_support(const DrawLaw& law, Range& range, std::set<double>& different) {
  const auto& p = law.parameters;
  if (law.kind == DistributionKind::kUniform || law.kind == DistributionKind::kLogUniform ||
      law.kind == DistributionKind::kInteger) {
    range.take(p[0]);
    range.take(p[1]);
  }
  for (const double number : law.numbers) {
    range.take(number);
    different.insert(static_cast<double>(static_cast<float>(number)));
  }
  if (law.kind != DistributionKind::kInteger) return;
  for (double x = std::ceil(p[0]); x <= p[1] && different.size() <= kMostValues; ++x) {
    different.insert(x);
  }
}

std::vector<double> bin_edges(const Range& range, std::size_t values, bool whole_numbers) {
  const auto bins = static_cast<double>(std::clamp(
      static_cast<std::size_t>(std::sqrt(static_cast<double>(values))), kFewestBins, kMostBins));
  double first = range.least;
  double width = (range.most - range.least) / bins;
  if (whole_numbers) {
    first = std::floor(range.least) - 0.5;
    width = std::ceil((range.most - first + 0.5) / bins);
  }
  if (!(width > 0.0)) {
    width = 1.0 / bins;
    first -= 0.5;
  }
  std::vector<double> edges;
  for (int i = 0; i <= static_cast<int>(bins); ++i) edges.push_back(first + i * width);
  if (!whole_numbers && range.most > range.least) edges.back() = range.most;
  return edges;
}

}  // namespace

void DrawTable::add(Variable& variable, std::int64_t scene, const Draw& draw) {
  if (draw.value.is_string()) {
    variable.names.push_back(draw.value.get<std::string>());
  } else {
    variable.numbers.push_back(static_cast<float>(draw.value.get<double>()));
  }
  ++variable.counts.back();
  if (!draw.law) {
    variable.has_law = false;
    return;
  }
  variable.level = draw.law->level;
  variable.kind = draw.law->kind;
  // What is drawn once a scene, or once in all, counts once.
  const bool counts =
      variable.level == Level::kFrame ||
      (variable.level == Level::kScene ? variable.last_scene != scene : variable.last_scene < 0) ||
      variable.last_frame == frames_;
  if (!counts) return;
  variable.last_scene = scene;
  variable.last_frame = frames_;
  ++variable.law_draws;
  auto& counted = variable.laws[key_of(*draw.law)];
  if (counted.draws == 0) counted.law = *draw.law;
  ++counted.draws;
}

void DrawTable::add(std::int64_t scene, const std::vector<Draw>& draws) {
  ++frames_;
  for (const Draw& draw : draws) {
    Variable& variable = variables_[without_copy(draw.name)];
    variable.counts.resize(frames_, 0);
    add(variable, scene, draw);
  }
}

/// The share of all draws for which the laws say so; null where any of them does not.
Json DrawTable::expected(const Variable& variable, const ShareOf& share_of) {
  if (!variable.has_law || variable.law_draws == 0) return {};
  double sum = 0.0;
  for (const auto& [key, counted] : variable.laws) {
    const std::optional<double> share = share_of(counted.law);
    if (!share) return {};
    sum += *share * static_cast<double>(counted.draws) / static_cast<double>(variable.law_draws);
  }
  constexpr double kDigits = 1e6;  // more than a chart shows
  return std::round(sum * kDigits) / kDigits;
}

Json DrawTable::expected_between(const Variable& variable, double low, double high) {
  return expected(variable, [&](const DrawLaw& law) -> std::optional<double> {
    const auto above = share_up_to(law, high);
    const auto below = share_up_to(law, low);
    return above && below ? std::optional(*above - *below) : std::nullopt;
  });
}

void DrawTable::add_names(const Variable& variable, Json& json) {
  std::set<std::string> all(variable.names.begin(), variable.names.end());
  for (const auto& [key, counted] : variable.laws) {
    all.insert(counted.law.names.begin(), counted.law.names.end());
  }
  const std::vector<std::string> sorted(all.begin(), all.end());
  std::vector<std::uint16_t> places;
  for (const std::string& value : variable.names) {
    const auto found = std::lower_bound(sorted.begin(), sorted.end(), value);
    places.push_back(
        static_cast<std::uint16_t>(std::min<std::ptrdiff_t>(found - sorted.begin(), 65'535)));
  }
  Json shares = Json::array();
  for (const std::string& value : sorted) {
    shares.push_back(expected(variable, [&](const DrawLaw& law) -> std::optional<double> {
      double weight = 0.0;
      for (std::size_t i = 0; i < law.names.size(); ++i) {
        if (law.names[i] == value) weight += law.weights[i];
      }
      return weight / all_of(law.weights);
    }));
  }
  json["names"] = sorted;
  json["values"] = column_of(places);
  json["expected"] = std::move(shares);
}

void DrawTable::add_numbers(const Variable& variable, Json& json) {
  json["values"] = column_of(variable.numbers);
  Range range;
  std::set<double> different;
  for (const float value : variable.numbers) {
    range.take(static_cast<double>(value));
    if (different.size() <= kMostValues) different.insert(static_cast<double>(value));
  }
  bool discrete = variable.has_law && variable.law_draws > 0;
  for (const auto& [key, counted] : variable.laws) {
    discrete = discrete && is_discrete(counted.law);
    take_support(counted.law, range, different);
  }
  Json shares = Json::array();
  if (discrete && different.size() <= kMostValues) {
    const std::vector<double> sorted(different.begin(), different.end());
    for (const double x : sorted) {
      const double reach = 1e-6 * std::max(1.0, std::abs(x));  // the values are floats
      shares.push_back(expected_between(variable, x - reach, x + reach));
    }
    json["numbers"] = sorted;
  } else {
    const std::vector<double> edges = bin_edges(range, variable.numbers.size(), discrete);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      shares.push_back(expected_between(variable, edges[i], edges[i + 1]));
    }
    json["edges"] = edges;
  }
  json["expected"] = std::move(shares);
}

Json DrawTable::variable_json(const std::string& name, const Variable& variable) const {
  std::vector<std::uint32_t> offsets = {0};
  bool one_each = variable.counts.size() == frames_;
  for (std::size_t frame = 0; frame < frames_; ++frame) {
    const std::uint32_t count = frame < variable.counts.size() ? variable.counts[frame] : 0;
    one_each = one_each && count == 1;
    offsets.push_back(offsets.back() + count);
  }
  Json json = {{"name", name}, {"offsets", one_each ? Json() : column_of(offsets)}};
  if (variable.has_law && variable.law_draws > 0) {
    json["level"] = name_of(variable.level);
    json["law"] = variable.laws.size() == 1
                      ? words_of(variable.laws.begin()->second.law)
                      : fmt::format("{}, parameters vary", name_of(variable.kind));
  }
  if (variable.names.empty()) {
    add_numbers(variable, json);
  } else {
    add_names(variable, json);
  }
  return json;
}

Json DrawTable::to_json() const {
  Json json = Json::array();
  for (const auto& [name, variable] : variables_) json.push_back(variable_json(name, variable));
  return json;
}

}  // namespace seedframe
