#include "config/determinism_section.h"

#include <fmt/format.h>

#include "base/nearest_name.h"

namespace seedframe {
namespace {

using Mode = Determinism::Mode;

Mode read_mode(const ConfigNode& node, Diagnostics& errors) {
  const std::string text = node.is_scalar() ? node.text() : "";
  if (text == "machine") return Mode::kMachine;
  if (text == "portable") return Mode::kPortable;
  if (text == "none") return Mode::kNone;
  errors.add(node.place(), "expected 'machine', 'portable' or 'none', found " + node.description() +
                               did_you_mean(text, {"machine", "portable", "none"}));
  return Mode::kMachine;
}

Isa read_isa(const ConfigNode& node, Mode mode, Diagnostics& errors) {
  const std::optional<Isa> isa = isa_of(node.is_scalar() ? node.text() : "");
  if (!isa) {
    errors.add(node.place(), fmt::format("expected one of {}, found {}",
                                         fmt::join(isa_names(), ", "), node.description()));
  } else if (mode != Mode::kPortable) {
    errors.add(node.place(), "only 'mode: portable' pins the instruction set");
  }
  return isa.value_or(Isa::kAvx2);
}

}  // namespace

Determinism read_determinism(SectionReader& campaign, const RenderConfig& render) {
  Determinism determinism;
  if (const auto node = campaign.find("determinism"); node && node->is_scalar()) {
    determinism.mode = read_mode(*node, campaign.errors());
  } else if (node) {
    SectionReader section(*node, campaign.errors());
    if (const auto mode = section.find("mode")) {
      determinism.mode = read_mode(*mode, campaign.errors());
    }
    if (const auto isa = section.find("isa")) {
      determinism.isa = read_isa(*isa, determinism.mode, campaign.errors());
    }
    section.refuse_other_keys();
  }
  if (render.persistent_data && determinism.mode != Mode::kNone) {
    campaign.errors().add(
        render.place,
        "persistent_data makes the pixels of a frame depend on the frames that its worker rendered "
        "before (docs/determinism.md): leave it out, or give the promise up with "
        "'determinism: none'");
  }
  if (render.levers.path_guiding && determinism.mode != Mode::kNone) {
    campaign.errors().add(
        render.place,
        "nothing holds path_guiding to learning the same whatever the threads do, so it is not "
        "part of the promise: leave it out, or give the promise up with 'determinism: none'");
  }
  if (render.device != RenderDevice::kCpu && determinism.mode == Mode::kPortable) {
    campaign.errors().add(render.place,
                          fmt::format("determinism: portable pins kernels of the CPU, and "
                                      "render.device is {}: choose one of them",
                                      name_of(render.device)));
  }
  return determinism;
}

}  // namespace seedframe
