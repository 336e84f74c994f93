// What is started as Blender: its executable, or a Python that has it as the module bpy.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"

namespace seedframe {

struct BlenderProgram {
  std::filesystem::path path;    ///< the executable or the Python, to be started: absolute
  std::filesystem::path module;  ///< the folder of bpy in that Python; empty: `path` is Blender

  bool operator==(const BlenderProgram&) const = default;
  /// As --blender takes it: a path, or "python:" and a path.
  std::string name() const;
};

/// What --blender names: the path of an executable, a name to look up in PATH, or "python:" and a
/// virtual environment's folder or its Python. kEnvironment errors: not found, not executable, no
/// module bpy in that Python; each says what to do.
Result<BlenderProgram> find_blender(const std::string& name);

/// The version of a module, by what its installer noted beside it: "4.5.15". kEnvironment: nothing
/// is noted.
Result<std::string> module_version(const BlenderProgram& blender);

/// A hash over the program itself: of a module, of the library that it consists of, as its
/// installer noted it, or else as it is.
Result<std::string> sha256_of(const BlenderProgram& blender);

/// Starts Blender without windows, sound, add-ons and anybody's preferences, and in it `script`, to
/// which what is appended to the command are arguments. `scripts` is the folder blender_scripts/.
std::vector<std::string> blender_command(const BlenderProgram& blender,
                                         const std::filesystem::path& scripts, int threads,
                                         const std::filesystem::path& script);

}  // namespace seedframe
