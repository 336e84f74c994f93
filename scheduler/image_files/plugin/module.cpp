#include <algorithm>
#include <cstring>

#include <OpenImageIO/imageio.h>

#include "image_files/plugin/calls.h"

namespace seedframe::image_module {

bool refuse(Fault* fault, const std::string& reason) {
  const std::size_t size = std::min(reason.size(), sizeof(fault->text) - 1);
  std::memcpy(fault->text, reason.data(), size);
  fault->text[size] = '\0';
  std::replace(fault->text, fault->text + size, '\n', ' ');
  return false;
}

namespace {

constexpr Table kTable = {kVersion, read_image, write_image, resize_image};

/// Once, before anything else is asked of the library.
void set_limits() {
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1);        // none: OpenEXR's pool is shared with the program
  OIIO::attribute("plugin_searchpath", "");  // no formats but those built in
  OIIO::attribute("limits:channels", 256);
  OIIO::attribute("limits:imagesize_MB", 4096);  // of decoded pixels
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const Table* seedframe_image_module() {
  static const bool set = (set_limits(), true);
  (void)set;
  return &kTable;
}

}  // namespace seedframe::image_module
