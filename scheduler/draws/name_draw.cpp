#include "draws/name_draw.h"

#include "base/nearest_name.h"
#include "draws/quantile.h"

namespace seedframe {

std::vector<NameDraw::Piece> NameDraw::split(const std::string& text, const CompileScope& scope,
                                             const Place& place, Diagnostics& errors) {
  constexpr std::size_t kLongest = 2000;  // as a formula
  std::vector<Piece> pieces;
  std::size_t start = 0;
  if (text.size() > kLongest) {
    errors.add(place,
               fmt::format("a name may have {} characters, found {}", kLongest, text.size()));
    return pieces;
  }
  while (start < text.size()) {
    const std::size_t open = text.find("${", start);
    if (open == std::string::npos) break;
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) {
      errors.add(place, "'" + text + "': '${' without '}'");
      return pieces;
    }
    const std::string variable = text.substr(open + 2, close - open - 2);
    const auto found = scope.symbols.find(variable);
    if (found == scope.symbols.end() || found->second.type.type != ValueType::kText) {
      std::vector<std::string> known;
      for (const auto& [name, symbol] : scope.symbols) {
        if (symbol.type.type == ValueType::kText) known.push_back(name);
      }
      errors.add(place, "there is no variable of names '" + variable + "' here" +
                            did_you_mean(variable, known));
      return pieces;
    }
    pieces.push_back({text.substr(start, open - start), found->second.slot});
    start = close + 1;
  }
  if (start < text.size() || pieces.empty()) pieces.push_back({text.substr(start), {}});
  return pieces;
}

NameDraw NameDraw::compile(const NameSource& source, const CompileScope& scope,
                           const std::string& name, Level level, Diagnostics& errors) {
  NameDraw draw;
  draw.place_ = source.place;
  draw.level_ = level;
  draw.name_ = name;
  if (source.options.size() > 1) draw.stream_ = PhiloxStream(scope.seed, name);
  for (const NameSource::Option& option : source.options) {
    draw.options_.push_back(
        {split(option.text, scope, source.place, errors),
         NumberDraw::compile_any(option.weight, scope, name + ".weight." + option.text, level,
                                 errors)});
  }
  return draw;
}

std::string NameDraw::evaluate(EvaluationContext& context) const {
  if (!stream_ && options_[0].pieces.size() == 1 && !options_[0].pieces[0].variable) {
    return options_[0].pieces[0].text;
  }
  std::size_t chosen = 0;
  std::vector<double> weights;
  if (stream_) {
    for (const Option& option : options_) weights.push_back(option.weight.evaluate(context));
    if (const std::string wrong = quantile::weight_error(weights); !wrong.empty()) {
      context.report(place_, wrong);
    } else {
      chosen = quantile::choice(stream_->uniform(context.position(level_)), weights);
    }
  }
  const auto text_of = [&context](const Option& option) {
    std::string text;
    for (const Piece& piece : option.pieces) {
      text += piece.text;
      if (piece.variable) text += context.values.texts[*piece.variable];
    }
    return text;
  };
  std::string value = text_of(options_[chosen]);
  if (stream_ && context.record != nullptr) {
    DrawLaw law;
    law.level = level_;
    law.kind = DistributionKind::kChoice;
    law.weights = std::move(weights);
    for (const Option& option : options_) law.names.push_back(text_of(option));
    context.record->push_back({draw_name(name_, context), value, std::move(law)});
  }
  return value;
}

std::optional<std::vector<std::string>> NameDraw::possible_values() const {
  std::vector<std::string> values;
  for (const Option& option : options_) {
    std::string value;
    for (const Piece& piece : option.pieces) {
      if (piece.variable) return std::nullopt;
      value += piece.text;
    }
    values.push_back(value);
  }
  return values;
}

}  // namespace seedframe
