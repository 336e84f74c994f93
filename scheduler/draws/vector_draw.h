// Three numbers of a config, or a formula that gives a vector.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>

#include "draws/number_draw.h"

namespace seedframe {

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

}  // namespace seedframe
