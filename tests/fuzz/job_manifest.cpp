#include "annotate/labels.h"
#include "frames/manifest.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/targets.h"

namespace seedframe {
namespace {

void fuzz_manifest(std::string_view bytes) {
  const auto manifest = parse_manifest(bytes, "manifest.json");
  if (!manifest) {
    promise(manifest.error().kind == ErrorKind::kCorrupt, "a damaged manifest is one we wrote");
    return;
  }
  const std::string text = readable_json(to_json(*manifest));
  const auto again = parse_manifest(text, "manifest.json");
  promise(again.has_value(), "a manifest that was written can be read");
  promise(readable_json(to_json(*again)) == text, "writing and reading change no manifest");
}

void fuzz_labels(std::string_view bytes) {
  const auto json = parse_json(bytes, "labels.json");
  if (!json) return;
  const auto labels = labels_from_json(*json, "labels.json");
  if (!labels) {
    promise(labels.error().kind == ErrorKind::kCorrupt, "damaged labels are something we wrote");
    return;
  }
  const std::string text = canonical_json(to_json(*labels));
  const auto again = labels_from_json(*parse_json(text, "labels.json"), "labels.json");
  promise(again.has_value(), "labels that were written can be read");
  promise(canonical_json(to_json(*again)) == text, "writing and reading change no labels");
}

}  // namespace

void fuzz_job_manifest(std::string_view bytes) {
  fuzz_manifest(bytes);
  fuzz_labels(bytes);
}

}  // namespace seedframe
