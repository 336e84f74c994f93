#include "draws/graphs.h"

#include <algorithm>
#include <cmath>

#include "base/canonical_json.h"
#include "base/files.h"
#include "base/nearest_name.h"

namespace seedframe {
namespace {

/// What is wrong with one value, or empty.
std::string take_value(const Json& value, const GraphVariable& variable, GivenValues& given) {
  if (variable.type.type == ValueType::kText) {
    if (!value.is_string()) return "expected a name";
    given.names.push_back(value.get<std::string>());
    return {};
  }
  std::array<double, 3> numbers{};
  if (variable.type.type == ValueType::kVector) {
    if (!value.is_array() || value.size() != 3) return "expected [x, y, z]";
    for (std::size_t i = 0; i < 3; ++i) {
      if (!value[i].is_number()) return "expected [x, y, z]";
      numbers[i] = value[i].get<double>();
    }
  } else {
    if (!value.is_number()) return "expected a number";
    numbers[0] = value.get<double>();
  }
  if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })) {
    return "a number must be finite";
  }
  given.numbers.push_back(numbers);
  return {};
}

std::string take_values(const Json& value, const GraphVariable& variable, GivenValues& given) {
  const bool is_vector = variable.type.type == ValueType::kVector;
  const bool is_list =
      value.is_array() && (!is_vector || (!value.empty() && value.front().is_array()));
  if (!is_list) return take_value(value, variable, given);
  if (!variable.per_copy) return "expected one value: this variable has no copies";
  if (value.empty()) return "expected a value for each copy, found none";
  given.per_copy = true;
  for (const Json& item : value) {
    if (std::string wrong = take_value(item, variable, given); !wrong.empty()) return wrong;
  }
  return {};
}

// Names of variables are identifiers, which none of these is.
constexpr const char* kSceneKey = "@scene";
constexpr const char* kRenderKey = "@render";

Status take_rendering(const Json& wishes, RenderingWish& rendering) {
  if (!wishes.is_object()) return fail(ErrorKind::kInput, "expected an object");
  for (const auto& [key, value] : wishes.items()) {
    const Result<bool> taken = take_rendering_wish(key, value, rendering);
    if (!taken) return forward_error(taken);
    if (*taken) continue;
    return fail(ErrorKind::kInput, "unknown key '{}'{}", key,
                did_you_mean(key, {"samples", "denoise", "crop", "depth"}));
  }
  return {};
}

Result<Graph> read_graph(Json line, const GraphVariables& variables, const std::string& where) {
  Graph graph;
  if (const auto scene = line.is_object() ? line.find(kSceneKey) : line.end();
      scene != line.end()) {
    graph.scene = integer_in<std::uint32_t>(*scene);
    if (!graph.scene) {
      return fail(ErrorKind::kInput,
                  "{}: {}: expected a whole number from 0 to 4294967295, found {}", where,
                  kSceneKey, scene->dump().substr(0, 60));
    }
    line.erase(scene);
  }
  if (const auto render = line.is_object() ? line.find(kRenderKey) : line.end();
      render != line.end()) {
    if (Status taken = take_rendering(*render, graph.rendering); !taken) {
      return fail(ErrorKind::kInput, "{}: {}: {}", where, kRenderKey, taken.error().message);
    }
    line.erase(render);
  }
  Result<std::vector<GivenValues>> values = read_values(line, variables, where);
  if (!values) return forward_error(values);
  graph.values = std::move(*values);
  return graph;
}

}  // namespace

std::string graph_line(const Json& values, std::int64_t scene, const RenderingWish& rendering) {
  Json line = values;
  line[kSceneKey] = scene;
  if (rendering != RenderingWish{}) line[kRenderKey] = to_json(rendering);
  return canonical_json(line);
}

Result<Graphs> Graphs::open(const std::filesystem::path& file, Kind kind) {
  Result<std::string> text = read_file(file, kMostGraphBytes);
  if (!text) return fail(ErrorKind::kInput, "{}", text.error().message);
  Graphs graphs;
  graphs.file_ = file.string();
  if (kind == Kind::kGrowing) text->erase(text->rfind('\n') + 1);  // npos + 1: all of it
  graphs.text_ = std::make_shared<const std::string>(std::move(*text));
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < graphs.text_->size();) {
    const std::size_t end = std::min(graphs.text_->find('\n', begin), graphs.text_->size());
    ++number;
    const std::string_view line(graphs.text_->data() + begin, end - begin);
    if (line.find_first_not_of(" \t\r") != std::string_view::npos) {
      if (graphs.lines_.size() == kMostGraphs) {
        return fail(ErrorKind::kInput, "{} has more than {} lines", graphs.file_, kMostGraphs);
      }
      graphs.lines_.push_back({begin, end - begin, number});
    }
    begin = end + 1;
  }
  if (graphs.lines_.empty() && kind == Kind::kWhole) {
    return fail(ErrorKind::kInput, "{} has no lines", graphs.file_);
  }
  return graphs;
}

Result<Graph> Graphs::read(std::int64_t index, const GraphVariables& variables) const {
  const Line& line = lines_.at(static_cast<std::size_t>(index));
  const std::string where = fmt::format("{}:{}", file_, line.number);
  Result<Json> graph = parse_json(std::string_view(*text_).substr(line.begin, line.length), where);
  if (!graph) return fail(ErrorKind::kInput, "{}", graph.error().message);
  return read_graph(std::move(*graph), variables, where);
}

Result<std::vector<GivenValues>> read_values(const Json& values, const GraphVariables& variables,
                                             const std::string& where) {
  if (!values.is_object()) {
    return fail(ErrorKind::kInput, "{}: expected an object, such as {{\"yaw\": 90}}", where);
  }
  std::vector<GivenValues> given(variables.size());
  for (const auto& [key, value] : values.items()) {
    const auto found = variables.find(key);
    if (found == variables.end()) {
      std::vector<std::string> known;
      for (const auto& entry : variables) known.push_back(entry.first);
      return fail(ErrorKind::kInput, "{}: the config has no variable '{}'{}", where, key,
                  did_you_mean(key, known));
    }
    const GraphVariable& variable = found->second;
    const std::string wrong = take_values(value, variable, given[variable.index]);
    if (!wrong.empty()) {
      return fail(ErrorKind::kInput, "{}: {}: {}, found {}", where, key, wrong,
                  value.dump().substr(0, 60));
    }
  }
  return given;
}

}  // namespace seedframe
