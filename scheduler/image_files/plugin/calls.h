// The calls of the module's table, and what they share.
#pragma once

#include <cstddef>
#include <exception>
#include <string>

#include "image_files/module_table.h"

namespace seedframe::image_module {

bool read_image(const char* reader, const void* bytes, std::size_t size, const ReadCalls* calls,
                Fault* fault);
bool write_image(const WriteRequest* request, const ByteSink* sink, Fault* fault);
bool resize_image(const FloatPixels* from, const FloatPixels* to, const char* filter_across,
                  const char* filter_down, Fault* fault);

/// Writes the reason, as much of it as there is room for; returns false.
bool refuse(Fault* fault, const std::string& reason);

/// What `call` returns; what it throws ends here, as a fault.
template <class Call>
bool guarded(Fault* fault, const Call& call) {
  try {
    return call();
  } catch (const std::exception& error) {
    return refuse(fault, error.what());
  } catch (...) {
    return refuse(fault, "unknown failure");
  }
}

}  // namespace seedframe::image_module
