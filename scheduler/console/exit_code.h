// What the program's exit code says; the README lists it for users.
#pragma once

#include <cstdio>
#include <string>

#include "base/canonical_json.h"
#include "base/error.h"
#include "base/message_text.h"

namespace seedframe {

enum ExitCode : int {
  kExitOk = 0,
  kExitInternal = 1,     ///< a mistake in Seedframe itself
  kExitInput = 2,        ///< the config, an argument or the output folder; nothing was written
  kExitSomeFailed = 3,   ///< some frames failed, or some formats cannot be exported to
  kExitEnvironment = 4,  ///< Blender, the disk or the system is not as needed
  kExitCorrupt = 5,      ///< files are not as Seedframe wrote them
  // Of verbs that compare pixels: the worst that they found.
  kExitRounding = 6,         ///< labels identical, colours within some units in the last place
  kExitTolerance = 7,        ///< labels identical, colours within the tolerance
  kExitLabels = 8,           ///< labels differ
  kExitNotReproducible = 9,  ///< colours beyond the tolerance, or frames missing
  kExitErrorBound = 10,      ///< frames are further from their references than was promised
  kExitInterrupted = 130     ///< stopped by a signal; 'resume' goes on
};

inline ExitCode exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kInput:
      return kExitInput;
    case ErrorKind::kEnvironment:
    case ErrorKind::kExhausted:
      return kExitEnvironment;
    case ErrorKind::kCorrupt:
      return kExitCorrupt;
    case ErrorKind::kRender:
      return kExitSomeFailed;
  }
  return kExitInternal;
}

/// Set where the arguments ask for JSON: then standard output says what went wrong, too.
inline bool errors_as_json = false;

/// What JSON says of an error, after a line "seedframe: error: …" on standard error for each line
/// of it.
inline Json told_error(const std::string& message, ExitCode code) {
  Json messages = Json::array();
  std::size_t start = 0;
  while (start <= message.size()) {
    const std::size_t end = std::min(message.find('\n', start), message.size());
    messages.push_back(printable(message.substr(start, end - start)));
    std::fprintf(stderr, "seedframe: error: %s\n", messages.back().get<std::string>().c_str());
    start = end + 1;
  }
  return {{"exit_code", static_cast<int>(code)}, {"messages", messages}};
}

/// Prints an error, and returns its code.
inline int report(const std::string& message, ExitCode code) {
  const Json told = {{"error", told_error(message, code)}};
  if (errors_as_json) {
    std::printf("%s\n", told.dump(1, ' ', false, Json::error_handler_t::replace).c_str());
  }
  return code;
}

inline int report(const Error& error) { return report(error.message, exit_code(error.kind)); }

}  // namespace seedframe
