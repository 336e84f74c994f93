#include "image/exr_file.h"
#include "image/exr_metadata.h"
#include "image/pass_reader.h"
#include "tests/fuzz/memory_file.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/targets.h"

namespace seedframe {
namespace {

/// What the seeds of the corpus hold.
const PassExpectation kExpected = {
    .width = 4, .height = 3, .depth = true, .normal = true, .max_instance_id = 2};

/// The copy of a frame is that frame, and its own copy.
void check_copy(const FramePasses& passes, const std::string& copy) {
  static const MemoryFile file;
  file.write(copy);
  const auto again = read_passes(file.path(), kExpected);
  promise(again.has_value(), "the copy of good passes can be read");
  promise(again->pixel_hashes == passes.pixel_hashes, "the copy of a frame has its pixels");
  const auto second = without_metadata(copy, "copy");
  promise(second.has_value(), "a copy can be copied");
  promise(*second == copy, "the copy of a copy is the copy");
}

}  // namespace

void fuzz_exr_front(std::string_view bytes) {
  static const MemoryFile file;
  file.write(bytes);
  const auto passes = read_passes(file.path(), kExpected);
  const auto copied = without_metadata(bytes, "passes");
  for (const auto& error : {passes ? ErrorKind::kRender : passes.error().kind,
                            copied ? ErrorKind::kRender : copied.error().kind}) {
    promise(error == ErrorKind::kRender, "bad passes are the worker's fault");
  }
  if (passes) {
    promise(copied.has_value(), "good passes can be copied");
    check_copy(*passes, *copied);
  }
  const auto depth = read_exr_channel(file.path(), "Z");
  if (!depth) promise(depth.error().kind == ErrorKind::kCorrupt, "a bad export is corrupt");
}

}  // namespace seedframe
