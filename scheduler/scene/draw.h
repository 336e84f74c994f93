// Config values ready to be evaluated: constants, formulas, and draws that know their key.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/philox.h"
#include "config/campaign_config.h"
#include "config/values.h"
#include "scene/formula.h"
#include "scene/frame_spec.h"

namespace seedframe {

/// One draw that was made, for people: "objects.bolts.rotation_deg[2]/3" = 117.2.
struct Draw {
  std::string name;
  Json value;  ///< a number or a name
};

/// Where in the campaign values are being evaluated, and what came of it.
struct EvaluationContext {
  std::uint32_t scene = 0;
  std::uint32_t frame = 0;        ///< within its scene
  std::uint32_t copy = kNoIndex;  ///< of the object or light being evaluated
  std::uint32_t attempt = 0;      ///< of a placement that may be rejected
  std::optional<Error> error;     ///< the first; evaluation goes on with zeros
  std::vector<Draw>* record = nullptr;

  PhiloxStream::Position position(Level level) const;
  void report(const Place& place, const std::string& message);
};

/// What formulas and names may refer to at one place of the config.
struct CompileScope {
  std::uint64_t seed = 0;
  Scope numbers;
  std::map<std::string, const std::string*> names;
};

class NumberDraw {
 public:
  NumberDraw() = default;
  /// `name` keys the draws of a distribution; a nested distribution appends to it.
  static NumberDraw compile(const NumberSource& source, const CompileScope& scope,
                            const std::string& name, Level level, Diagnostics& errors);

  /// Finite; what is not is reported, and then 0.
  double evaluate(EvaluationContext& context) const;

  const Place& place() const { return place_; }

 private:
  struct Random {
    DistributionKind kind;
    Level level;
    std::string name;
    PhiloxStream stream;
    std::vector<NumberDraw> parameters;
    std::vector<NumberDraw> weights;
  };
  double draw(const Random& random, EvaluationContext& context) const;

  Place place_;
  std::variant<double, std::shared_ptr<const CompiledFormula>, std::shared_ptr<const Random>>
      value_ = 0.0;
};

class VectorDraw {
 public:
  static VectorDraw compile(const std::array<NumberSource, 3>& components,
                            const CompileScope& scope, const std::string& name, Level level,
                            Diagnostics& errors);
  Eigen::Vector3d evaluate(EvaluationContext& context) const;

 private:
  std::array<NumberDraw, 3> components_;
};

class ColorDraw {
 public:
  static ColorDraw compile(const ColorSource& source, const CompileScope& scope,
                           const std::string& name, Level level, Diagnostics& errors);
  /// Linear Rec.709, none below 0.
  Rgb evaluate(EvaluationContext& context) const;

 private:
  ColorModel model_ = ColorModel::kRgb;
  std::array<NumberDraw, 3> components_;
};

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
    const std::string* variable = nullptr;  ///< appended after the text
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
