// Arrays that a client on this machine maps instead of reading them from a pipe: memory without a
// name, which goes with the last process that has it open or mapped, however that ends.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"

namespace seedframe {

class SharedArrays {
 public:
  SharedArrays() = default;
  ~SharedArrays();
  SharedArrays(SharedArrays&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)),
        bytes_(std::exchange(other.bytes_, 0)),
        arrays_(std::move(other.arrays_)) {}
  SharedArrays& operator=(SharedArrays&& other) noexcept;

  /// Appends an array, row by row. kExhausted: there is no memory.
  Status add(const std::string& name, const void* data, std::size_t bytes, const char* dtype,
             const std::vector<int>& shape);

  bool empty() const { return bytes_ == 0; }
  /// {"path": "/proc/123/fd/7", "bytes": …, "image": {"offset": 0, "dtype": "uint8", "shape": …}}
  Json to_json() const;

 private:
  int descriptor_ = -1;
  std::size_t bytes_ = 0;
  Json arrays_ = Json::object();
};

}  // namespace seedframe
