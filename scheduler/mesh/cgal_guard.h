// Where CGAL's exceptions end.
#pragma once

#include <exception>
#include <string>
#include <utility>

#include <CGAL/assertions.h>

#include "base/error.h"

namespace seedframe {

/// Calls `function`, which returns a Result or a Status; what CGAL throws, from a violated
/// precondition to too little memory, becomes an error (kInput) that says what was tried.
template <class Function>
auto guard_cgal(const std::string& what, Function&& function) -> decltype(function()) {
  // The default, but a process may have set it otherwise: a strange mesh must not abort it.
  CGAL::set_error_behaviour(CGAL::THROW_EXCEPTION);
  try {
    return std::forward<Function>(function)();
  } catch (const std::exception& error) {
    return fail(ErrorKind::kInput, "{} failed: {}", what, error.what());
  }
}

}  // namespace seedframe
