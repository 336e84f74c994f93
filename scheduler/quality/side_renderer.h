// Frames rendered beside a campaign: with other settings, of which nothing stays but what is asked
// of their passes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/run_options.h"
#include "image/pass_reader.h"
#include "render/message.h"
#include "scene/expanded_frame.h"

namespace seedframe {

/// One rendering: the frame as it is to be rendered, and what came of it. Jobs are numbered from 0.
struct SideFrame {
  FrameSpec spec;
  std::string id;
  FramePasses passes;
  RenderTimings timings;
  std::filesystem::path
      scene;  ///< a .blend that goes when it was looked at; empty: nobody wants it
};

/// What the renderer asks and tells. `frame` comes from the thread that is in render(), `rendered`
/// from one other thread, in the order in which jobs are done.
class SideClient {
 public:
  virtual ~SideClient() = default;
  /// An error fails the job.
  virtual Result<ExpandedFrame> frame(std::int64_t job) = 0;
  /// Whether its passes are to have sample_shares.
  virtual bool wants_sample_counts(std::int64_t /*job*/) const { return false; }
  virtual bool wants_scene(std::int64_t /*job*/) const { return false; }
  /// An error ends all.
  virtual Status rendered(std::int64_t job, const SideFrame& frame) = 0;
  /// A job that could not be rendered.
  virtual void failed(std::int64_t job, const std::string& why) = 0;
};

/// Renders jobs 0 … count − 1 in order, with the setup's workers, none of them tried twice; files
/// are written into `scratch`, which is made, and removed again as they are read. kEnvironment and
/// kExhausted errors: no worker, no disk.
Status render_aside(std::int64_t count, const RunSetup& setup, const std::filesystem::path& scratch,
                    SideClient& client);

}  // namespace seedframe
