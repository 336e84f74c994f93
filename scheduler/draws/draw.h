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
#include "draws/sobol.h"
#include "formula/formula.h"
#include "spec/frame_spec.h"

namespace seedframe {

/// One draw that was made, for people: "objects.bolts.rotation_deg[2]/3" = 117.2.
struct Draw {
  std::string name;
  Json value;  ///< a number or a name
};

/// Where in the campaign values are being evaluated, and what came of it.
struct EvaluationContext {
  std::uint32_t scene = 0;
  std::uint32_t frame = 0;  ///< within its scene
  std::uint32_t frames_per_scene = 1;
  /// The scene whose draws are used: another one where a sweep holds them.
  std::uint32_t draw_scene = 0;
  std::uint32_t copy = kNoIndex;        ///< of the object or light being evaluated, for its draws
  std::uint32_t ordinal = 0;            ///< of that copy among all of its section in the frame
  std::uint32_t frame_attempt = 0;      ///< to meet the constraints; changes frame-level draws
  std::uint32_t placement_attempt = 0;  ///< to find a free place
  std::optional<Error> error;           ///< the first; evaluation goes on with zeros
  std::vector<Draw>* record = nullptr;
  Json* graph = nullptr;  ///< takes the values of all variables, as docs/formats/graphs.md says

  PhiloxStream::Position position(Level level) const;
  void report(const Place& place, const std::string& message);
  void report_frame(const std::string& message);
};

/// What formulas and names may refer to at one place of the config.
struct CompileScope {
  std::uint64_t seed = 0;
  bool copies = false;  ///< whether there are several copies here
  Scope symbols;
};

class NumberDraw {
 public:
  NumberDraw() = default;
  /// `name` keys the draws of a distribution (a nested one appends to it) and says by its ending
  /// which unit is wanted (dimension_of_key).
  static NumberDraw compile(const NumberSource& source, const CompileScope& scope,
                            const std::string& name, Level level, Diagnostics& errors);
  /// The same where any unit will do.
  static NumberDraw compile_any(const NumberSource& source, const CompileScope& scope,
                                const std::string& name, Level level, Diagnostics& errors);

  /// In base units; finite: what is not is reported, and then 0.
  double evaluate(EvaluationContext& context) const;

  const Dimension& dimension() const { return dimension_; }
  const Place& place() const { return place_; }

 private:
  struct Random {
    DistributionKind kind;
    Level level;
    std::string name;
    PhiloxStream stream;
    std::vector<NumberDraw> parameters;
    std::vector<NumberDraw> weights;
    std::vector<double> constant_weights;  ///< when none of them varies
    std::shared_ptr<const std::vector<double>> samples;
    std::optional<SobolDimension> sobol;

    double uniform(const EvaluationContext& context) const;
  };
  static std::shared_ptr<const Random> compile_random(const NumberSource& source,
                                                      const CompileScope& scope,
                                                      const std::string& name, Level level,
                                                      Diagnostics& errors);
  static double draw(const Random& random, const Place& place, EvaluationContext& context);

  Place place_;
  Dimension dimension_;
  std::variant<double, std::shared_ptr<const CompiledFormula>, std::shared_ptr<const Random>>
      value_ = 0.0;
};

class VectorDraw {
 public:
  static VectorDraw compile(const VectorSource& source, const CompileScope& scope,
                            const std::string& name, Level level, Diagnostics& errors);
  static VectorDraw compile_any(const VectorSource& source, const CompileScope& scope,
                                const std::string& name, Level level, Diagnostics& errors);
  Eigen::Vector3d evaluate(EvaluationContext& context) const;

  const Dimension& dimension() const { return dimension_; }
  const NumberDraw& component(std::size_t i) const { return components_[i]; }
  const Place& place() const { return place_; }

 private:
  Place place_;
  Dimension dimension_;
  bool alike_ = false;  ///< the first component is for all three
  std::array<NumberDraw, 3> components_;
  std::shared_ptr<const CompiledFormula> formula_;
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
  std::optional<VectorDraw> formula_;
  bool constant_ = false;
  Rgb value_{};  ///< when constant
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

/// The key of a draw as people read it: with the copy, where there is one.
std::string draw_name(const std::string& name, const EvaluationContext& context);

}  // namespace seedframe
