/// @file
/// The loop without a clock, for scripts that are tried before they move anything.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint {

class RunDesk;

/// What ControllerLoop is, guard and all, but its time passes only when told, in the caller's
/// thread: the same calls have the same outcome to the last bit.
/// Real-time: no. Threads: one at a time.
class VirtualLoop {
 public:
  /// @throws MotionError as ControllerLoop
  VirtualLoop(std::unique_ptr<Drive> drive, const JointLimits& limits,
              const LoopOptions& options = {});
  ~VirtualLoop();
  VirtualLoop(VirtualLoop&&) noexcept;
  VirtualLoop& operator=(VirtualLoop&&) noexcept;

  /// Lets so many cycles pass, or fewer: until a run ends, or until nothing moves any more.
  /// @returns how many have passed, at least 1
  int pass(int cycles);

  // As ControllerLoop has them. A job's wait() does not let time pass.
  [[nodiscard]] std::shared_ptr<Job> run(std::shared_ptr<const Trajectory> trajectory);
  [[nodiscard]] std::shared_ptr<OpenJob> follow(std::shared_ptr<const Trajectory> first);
  void jog(const JointVector& velocity);
  void admit_hand(const std::function<void(const Measurement&)>& take);
  [[nodiscard]] bool jogging() const;
  [[nodiscard]] std::string jog_block() const;
  void set_override(double share);
  [[nodiscard]] double override_share() const;
  void switch_outputs(std::uint64_t mask, std::uint64_t values);
  [[nodiscard]] Measurement measured() const;
  [[nodiscard]] LoopCycle newest_cycle() const;
  [[nodiscard]] std::vector<ObservedCycle> observed(std::uint64_t from, std::size_t most) const;
  [[nodiscard]] bool guided() const;
  [[nodiscard]] bool busy() const;
  [[nodiscard]] JointVector position() const;
  [[nodiscard]] std::string fault() const;
  void require_power() const;
  [[nodiscard]] std::vector<LogRecord> fault_cycles() const;

 private:
  std::unique_ptr<RunDesk> desk_;
};

}  // namespace viapoint
