#include "console/tolerance_options.h"

#include <array>

#include <CLI/CLI.hpp>

#include "console/arguments.h"

namespace seedframe {

void add_tolerance_options(CLI::App& verb, Tolerance& tolerance) {
  verb.add_option("--ulp", tolerance.ulp,
                  "colours that differ by no more units in the last place count as rounding")
      ->check(NotNegative())
      ->capture_default_str();
  verb.add_option("--max", tolerance.max, "most that a scene-linear value may differ by")
      ->check(NotNegative())
      ->capture_default_str();
  verb.add_option("--rms", tolerance.rms, "most that a picture may, root mean square")
      ->check(NotNegative())
      ->capture_default_str();
  verb.add_option("--psnr", tolerance.psnr_db, "least peak signal-to-noise ratio, in dB")
      ->capture_default_str();
  verb.add_option("--pixels", tolerance.pixels, "most of its pixels that may differ at all, 0 to 1")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
}

ExitCode exit_code(Grade grade) {
  constexpr std::array<ExitCode, 5> kCodes = {kExitOk, kExitRounding, kExitTolerance, kExitLabels,
                                              kExitNotReproducible};
  return kCodes[static_cast<std::size_t>(grade)];
}

}  // namespace seedframe
