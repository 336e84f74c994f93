#include "spec/frame_spec_reader.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/targets.h"

namespace seedframe {

void fuzz_frame_spec(std::string_view bytes) {
  const auto json = parse_json(bytes, "spec.json");
  if (!json) return;
  const auto spec = frame_spec_from_json(*json, "spec.json");
  if (!spec) {
    promise(spec.error().kind == ErrorKind::kCorrupt, "a damaged spec is something that we wrote");
    return;
  }
  promise(non_finite_part(*spec).empty(), "JSON has finite numbers only");
  const std::string text = canonical_text(*spec);
  const Json written = to_json(*spec);
  promise(canonical_json(written) == text, "the text of a spec is canonical JSON");
  const auto again = frame_spec_from_json(written, "spec.json");
  promise(again.has_value(), "what was written can be read");
  promise(canonical_text(*again) == text, "writing and reading change no frame id");
}

}  // namespace seedframe
