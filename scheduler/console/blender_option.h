// The option --blender of the verbs that need one.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "console/home.h"

namespace seedframe {

/// Sets what find_blender takes; default_blender() if it is not given.
inline CLI::Option* add_blender_option(CLI::App& verb, std::string& blender) {
  blender = default_blender();
  return verb
      .add_option("--blender", blender,
                  "Blender: a path, a name in PATH, or python:VENV for the module bpy in a virtual "
                  "environment (default: the checkout's venv/blender, else blender in PATH)")
      ->envname("SEEDFRAME_BLENDER");
}

}  // namespace seedframe
