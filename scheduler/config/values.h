// What may stand where a config has a number, a vector, a colour or a name: a constant, a formula
// or a distribution. Only the syntax is known here; scene/ gives it meaning.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/config_node.h"

namespace seedframe {

struct Distribution;

/// A text such as "0.5 * spread + 10cm"; formula/formula.h knows its syntax.
struct Formula {
  std::string text;
};

struct NumberSource {
  Place place;
  std::variant<double, Formula, std::shared_ptr<const Distribution>> value = 0.0;
};

enum class DistributionKind {
  kUniform,          ///< [min, max)
  kNormal,           ///< mean, std
  kTruncatedNormal,  ///< mean, std, min, max
  kBoundedNormal,    ///< mean and std of what is drawn, min, max
  kLogUniform,       ///< [min, max), both positive
  kInteger,          ///< min to max, both included
  kPoisson,          ///< mean
  kChoice,           ///< one of the values, by weight; a mixture when they are distributions
  kEmpirical,        ///< one of the samples, each as likely
};

struct Distribution {
  DistributionKind kind = DistributionKind::kUniform;
  std::vector<NumberSource> parameters;  ///< in the order above; for kChoice the values
  std::vector<NumberSource> weights;     ///< kChoice only, as many as parameters
  /// kEmpirical only: a column of a CSV file, sorted.
  std::shared_ptr<const std::vector<double>> samples;
  /// The dimension of the scrambled Sobol' sequence that is its source, instead of a random stream.
  std::optional<int> sobol_dimension;
};

/// Three numbers, or one formula whose value is a vector.
struct VectorSource {
  std::array<NumberSource, 3> components;
  bool alike = false;  ///< the first component is for all three: one draw
  std::optional<NumberSource> formula;
};

enum class ColorModel { kRgb, kHsv, kKelvin, kFormula };

/// kRgb: linear Rec.709; kHsv: hue in degrees, saturation and value 0 to 1, of sRGB; kKelvin: the
/// colour temperature of a black body in the first component; kFormula: in the first component a
/// formula whose value is a vector, as kRgb.
struct ColorSource {
  ColorModel model = ColorModel::kRgb;
  std::array<NumberSource, 3> components;
};

/// A name, such as an asset's: text in which ${variable} stands for the value of a variable of
/// names, or a weighted choice of such texts.
struct NameSource {
  struct Option {
    std::string text;
    NumberSource weight;
  };
  Place place;
  std::vector<Option> options;  ///< at least one; exactly one for a constant
};

NumberSource number_constant(double value);

/// These report what is wrong and return something usable, so that one run finds every error.
NumberSource read_number(const ConfigNode& node, Diagnostics& errors);
VectorSource read_vector(const ConfigNode& node, Diagnostics& errors);
ColorSource read_color(const ConfigNode& node, Diagnostics& errors);
NameSource read_name(const ConfigNode& node, Diagnostics& errors);
double read_constant(const ConfigNode& node, Diagnostics& errors);
long long read_integer(const ConfigNode& node, long long least, long long most,
                       Diagnostics& errors);
bool read_flag(const ConfigNode& node, Diagnostics& errors);

/// True for {hsv: …}, {rgb: …} and {kelvin: …}.
bool is_color_mapping(const ConfigNode& node);

/// True for {choice: …} whose options are texts that are not numbers, and for a plain text in
/// quotes with ${…}: a variable of names rather than of numbers.
bool is_name_choice(const ConfigNode& node);

}  // namespace seedframe
