// Expected failures are values: Result<T> is a T or an Error that a user can act on.
#pragma once

#include <string>
#include <utility>

#include <fmt/core.h>
#include <tl/expected.hpp>

namespace seedframe {

/// What went wrong, by who can fix it; it decides the exit code of the program.
enum class ErrorKind {
  kInput,        ///< a config, asset, option or argument is wrong: fix it and run again
  kEnvironment,  ///< Blender, the disk or the system is not as needed
  kExhausted,    ///< the same, but it may pass: a full or failing disk, no memory or descriptors
  kCorrupt,      ///< something that Seedframe wrote is no longer what it wrote
  kRender,       ///< a worker could not render a frame
};

/// A message says what was expected, what was found, where, and what to do.
struct Error {
  ErrorKind kind = ErrorKind::kInput;
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;
using Status = Result<void>;

template <class... Args>
tl::unexpected<Error> fail(ErrorKind kind, fmt::format_string<Args...> format, Args&&... args) {
  return tl::unexpected(Error{kind, fmt::format(format, std::forward<Args>(args)...)});
}

/// Hands on the error of another Result.
template <class T>
tl::unexpected<Error> forward_error(const Result<T>& result) {
  return tl::unexpected(result.error());
}

}  // namespace seedframe
