// From one section of a config to draws.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/campaign_config.h"
#include "scene/compiled_config.h"
#include "scene/material_library.h"

namespace seedframe {

/// Compiles the values of one section, whose draws are keyed by "<section>.<key>".
class SectionCompiler {
 public:
  SectionCompiler(const CompileScope& scope, std::string section, Level level, Diagnostics& errors)
      : scope_(scope), section_(std::move(section)), level_(level), errors_(errors) {}

  Level level() const { return level_; }

  NumberDraw number(const NumberSource& source, const char* key) const {
    return NumberDraw::compile(source, scope_, name(key), level_, errors_);
  }
  std::optional<NumberDraw> number(const std::optional<NumberSource>& source,
                                   const char* key) const {
    return source ? std::optional(number(*source, key)) : std::nullopt;
  }
  VectorDraw vector(const VectorSource& source, const char* key) const {
    return VectorDraw::compile(source, scope_, name(key), level_, errors_);
  }
  ColorDraw color(const ColorSource& source, const char* key) const {
    return ColorDraw::compile(source, scope_, name(key), level_, errors_);
  }
  NameDraw text(const NameSource& source, const char* key) const {
    return NameDraw::compile(source, scope_, name(key), level_, errors_);
  }

  CompiledMaterial material(const MaterialConfig& config, const MaterialLibrary& library) const;
  /// Only the materials that the source can become, for each is compiled anew.
  /// Whoever has no asset cannot have its materials (kOwnMaterial).
  CompiledMaterials materials(const MaterialSource& source, const MaterialLibrary& library,
                              const std::string& key, bool has_asset) const;
  std::optional<CompiledGrid> grid(const std::optional<GridConfig>& config) const;

  /// An error for each name that the draw can become and that is neither known nor `besides`;
  /// `missing` words it.
  template <class Known>
  void refuse_unknown(const NameDraw& draw, const Known& known, const MaterialLibrary& library,
                      std::string (MaterialLibrary::*missing)(const std::string&) const,
                      std::string_view besides = {}) const {
    const auto possible = draw.possible_values();
    if (!possible) return;
    for (const std::string& value : *possible) {
      if (known.contains(value) || (!value.empty() && value == besides)) continue;
      errors_.add(draw.place(), (library.*missing)(value));
    }
  }

 private:
  std::string name(const char* key) const { return section_ + "." + key; }
  CompiledShare compile_share(const MaterialShareConfig& config, const MaterialLibrary& library,
                              const std::string& key) const;

  const CompileScope& scope_;
  std::string section_;
  Level level_;
  Diagnostics& errors_;
};

}  // namespace seedframe
