// The run of a campaign from outside: who is at work on it, and how it is ended and begun.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/campaign.h"

namespace seedframe {

/// A process below the scheduler's.
struct WorkerProcess {
  std::int64_t process = 0;
  std::optional<int> worker;  ///< that it is, or belongs to
  std::int64_t memory_bytes = 0;
};

struct RunState {
  std::optional<std::int64_t> scheduler;  ///< process that holds the campaign's lock
  std::int64_t memory_bytes = 0;          ///< of it alone
  std::vector<WorkerProcess> workers;     ///< by process id
  bool starting = false;                  ///< a run that was begun here has not taken the lock yet
  std::string last_words;                 ///< of a run that was begun here and failed
};

class RunControl {
 public:
  virtual ~RunControl() = default;
  virtual RunState state(const Campaign& campaign) = 0;
  /// Asks the scheduler to finish the frames under way and to end, as Ctrl-C does. kInput: nobody
  /// is at work, or it is no scheduler that holds the lock.
  virtual Status pause(const Campaign& campaign) = 0;
  /// Begins a run: of what is missing or failed, or of this frame. kInput: one is at work.
  virtual Status resume(const Campaign& campaign, std::optional<std::int64_t> frame) = 0;
};

/// Process that holds the lock, as /proc/locks tells it; none: nobody does, or a process that
/// cannot be seen from here.
std::optional<std::int64_t> lock_holder(const std::filesystem::path& lock);

/// Of this machine, by /proc and signals. Runs are begun by `program resume DIR …`, in a session of
/// their own: they go on when this process ends. What they print goes into logs/serve.log.
class ProcessControl : public RunControl {
 public:
  ProcessControl(std::filesystem::path program, std::vector<std::string> resume_options)
      : program_(std::move(program)), resume_options_(std::move(resume_options)) {}

  RunState state(const Campaign& campaign) override;
  Status pause(const Campaign& campaign) override;
  Status resume(const Campaign& campaign, std::optional<std::int64_t> frame) override;

 private:
  struct Child {
    std::filesystem::path campaign;
    int process = 0;
    std::optional<int> exit_code;
  };
  Child* child_of(const Campaign& campaign);

  std::filesystem::path program_;
  std::vector<std::string> resume_options_;
  std::vector<Child> children_;
};

}  // namespace seedframe
