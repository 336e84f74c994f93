// A number of a config: a constant, a formula, or one uniform through a quantile function.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/diagnostics.h"
#include "base/philox.h"
#include "config/values.h"
#include "draws/draw_law.h"
#include "draws/evaluation_context.h"
#include "draws/sobol.h"

namespace seedframe {

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
  static DrawLaw law_of(const Random& random, const std::array<double, 4>& parameters,
                        const std::vector<double>& drawn_weights);

  Place place_;
  Dimension dimension_;
  std::variant<double, std::shared_ptr<const CompiledFormula>, std::shared_ptr<const Random>>
      value_ = 0.0;
};

}  // namespace seedframe
