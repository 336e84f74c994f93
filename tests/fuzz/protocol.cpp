#include "render/message.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/targets.h"

namespace seedframe {

void fuzz_protocol(std::string_view bytes) {
  const auto message = parse_worker_message(bytes);
  if (message) return;
  promise(message.error().kind == ErrorKind::kRender, "what is no message is the worker's fault");
  promise(message.error().message.find('\0') == std::string::npos, "an error can be printed");
}

}  // namespace seedframe
