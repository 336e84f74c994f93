// The option --blender of the verbs that need one.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace seedframe {

/// Sets what find_blender takes.
inline CLI::Option* add_blender_option(CLI::App& verb, std::string& blender) {
  return verb
      .add_option("--blender", blender,
                  "Blender: a path, a name in PATH, or python:VENV for the module bpy in a virtual "
                  "environment")
      ->envname("SEEDFRAME_BLENDER")
      ->capture_default_str();
}

}  // namespace seedframe
