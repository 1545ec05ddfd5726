/// @file
/// One run as ordinary threads see it.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "realtime/motion_chain.hpp"
#include "realtime/run_log.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/motion_queue.hpp"

namespace viapoint {

/// Outlives the loop it ran in. Threads: any.
class LoopJob final : public OpenJob {
 public:
  /// @param log_records records to keep, > 0
  /// @param open whether the motion may get longer
  LoopJob(std::shared_ptr<const Trajectory> trajectory, const JointLimits& limits,
          std::size_t log_records, bool open);

  bool wait(double timeout) override;
  void pause() override { wish(Wish::kPause); }
  void resume() override { wish(Wish::kRun); }
  void step() override { wish(Wish::kStep); }
  void backward() override { wish(Wish::kBackward); }
  void stop(StopCategory category) override {
    wish(category == StopCategory::kRelease ? Wish::kRelease : Wish::kStop);
  }
  void on_input(const InputReaction& reaction) override;
  [[nodiscard]] RunState state() const override { return motion_.state; }
  [[nodiscard]] std::optional<InputWait> awaited() const override;
  [[nodiscard]] double nominal_time() const override { return motion_.nominal_time; }
  [[nodiscard]] double duration() const override { return chain_.duration(); }
  [[nodiscard]] std::uint64_t overruns() const override { return motion_.overruns; }
  [[nodiscard]] int move() const override { return motion_.move; }
  [[nodiscard]] std::vector<LogRecord> log() const override;
  [[nodiscard]] std::vector<LogRecord> log(std::uint64_t from, std::size_t count) const override;
  [[nodiscard]] RunReport report() const override;
  void lengthen(std::shared_ptr<const Trajectory> next, double leave) override;
  [[nodiscard]] LinkFate fate() override;
  void close() override { motion_.closed.store(true, std::memory_order_release); }
  [[nodiscard]] double earliest_leave() const override {
    return motion_.settled_time - chain_.last_start();
  }
  [[nodiscard]] std::uint64_t waited_cycles() const override { return motion_.waited_cycles; }

  /// What crosses the real-time boundary.
  [[nodiscard]] QueuedMotion* motion() { return &motion_; }
  /// True where the arm may be jogged meanwhile: it was paused, by whomever, and rests. A pause
  /// that the tick has not seen yet comes before the jog.
  [[nodiscard]] bool may_be_jogged() const {
    const NumberedWish wish = motion_.wish;
    if (wish.number == motion_.acted_on) return motion_.may_be_jogged;
    const RunState state = motion_.state;
    return wish.wish == Wish::kPause && (state == RunState::kPaused || state == RunState::kJogging);
  }
  /// True once the motion has come back and its log is complete.
  [[nodiscard]] bool ended() const;

  /// For the loop's companion thread.
  void append(std::span<const LogRecord> records);
  void end(std::string fault);

 private:
  void wish(Wish wish);

  QueuedMotion motion_;
  MotionChain chain_;
  mutable std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  bool ended_ = false;
  std::string fault_;
  RunLog log_;
};

}  // namespace viapoint
