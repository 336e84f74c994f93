// A name of a config: one of several, with variables in it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "draws/number_draw.h"

namespace seedframe {

class NameDraw {
 public:
  static NameDraw compile(const NameSource& source, const CompileScope& scope,
                          const std::string& name, Level level, Diagnostics& errors);
  std::string evaluate(EvaluationContext& context) const;
  const Place& place() const { return place_; }
  /// Every value it can take, or none where variables make that unknown.
  std::optional<std::vector<std::string>> possible_values() const;

 private:
  struct Piece {
    std::string text;
    std::optional<std::size_t> variable;  ///< its slot; appended after the text
  };
  struct Option {
    std::vector<Piece> pieces;
    NumberDraw weight;
  };
  static std::vector<Piece> split(const std::string& text, const CompileScope& scope,
                                  const Place& place, Diagnostics& errors);

  Place place_;
  Level level_ = Level::kCampaign;
  std::string name_;
  std::optional<PhiloxStream> stream_;  ///< none when there is one option
  std::vector<Option> options_;
};

}  // namespace seedframe
