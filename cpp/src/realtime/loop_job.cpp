#include "realtime/loop_job.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

/// Waits longer than this are waits without end [s].
constexpr double kForever = 1e8;

Problem problem_of(const AwaitedInput& missed, int move) {
  Problem problem;
  problem.code = ErrorCode::kInputTimeout;
  char text[96];
  std::snprintf(text, sizeof text, "input %d was not %s within %g s: the run has ended on its path",
                missed.input, missed.value ? "on" : "off", static_cast<double>(missed.timeout));
  problem.message = text;
  problem.ways_out = {"see what should have switched the input", "give it more time (timeout=)"};
  problem.move = move;
  problem.limit = static_cast<double>(missed.timeout);
  return problem;
}

}  // namespace

LoopJob::LoopJob(std::shared_ptr<const Trajectory> trajectory, const JointLimits& limits,
                 std::size_t log_records, bool open)
    : chain_(trajectory, limits), log_(log_records) {
  motion_.trajectory = std::move(trajectory);
  motion_.open = open;
}

void LoopJob::lengthen(std::shared_ptr<const Trajectory> next, double leave) {
  if (motion_.closed || !motion_.open) {
    throw MotionError(ErrorCode::kBusy, "the run takes no more motion", {"begin another run"});
  }
  if (chain_.is_settled() || fate() != LinkFate::kNotYet) {
    const MotionLink* link = chain_.lengthen(*next, leave, motion_.nominal_time);
    motion_.link.store(link, std::memory_order_release);
  } else {
    throw MotionError(ErrorCode::kBusy, "the motion handed over before has not been taken up yet",
                      {"wait until it is"});
  }
}

LinkFate LoopJob::fate() {
  LinkFate fate = LinkFate::kNotYet;
  if (motion_.link.load(std::memory_order_acquire) == nullptr) {
    fate = motion_.fate;
  } else if (ended()) {
    fate = LinkFate::kTooLate;
  }
  chain_.settle(fate);
  return fate;
}

bool LoopJob::wait(double timeout) {
  if (std::isnan(timeout)) {
    throw MotionError(ErrorCode::kBadArgument, "the time to wait is not a number");
  }
  std::unique_lock lock(mutex_);
  const auto is_over = [this] { return ended_; };
  if (timeout > kForever) {
    changed_.wait(lock, is_over);
  } else if (!changed_.wait_for(lock, std::chrono::duration<double>(std::max(timeout, 0.0)),
                                is_over)) {
    return false;
  }
  if (motion_.state == RunState::kFault) {
    Problem problem;
    problem.code = ErrorCode::kDriveFault;
    problem.message = fault_;
    problem.ways_out = {"clear the fault at the drive, then connect again"};
    problem.move = motion_.move;
    problem.time = motion_.nominal_time;
    throw MotionError(problem);
  }
  const AwaitedInput missed = motion_.missed;
  if (missed.input >= 0) throw MotionError(problem_of(missed, motion_.move));
  return true;
}

std::optional<InputWait> LoopJob::awaited() const {
  const AwaitedInput awaited = motion_.awaited;
  if (awaited.input < 0) return std::nullopt;
  return InputWait{awaited.input, awaited.value, awaited.timeout};
}

void LoopJob::wish(Wish wish) {
  NumberedWish present = motion_.wish;
  const auto is_final = [&] {
    return present.wish == Wish::kRelease ||
           (present.wish == Wish::kStop && wish != Wish::kRelease);
  };
  while (!is_final() && !motion_.wish.compare_exchange_weak(present, {present.number + 1, wish})) {
  }
}

void LoopJob::on_input(const InputReaction& reaction) {
  const auto place = std::ranges::find(kReactions, reaction.wish);
  if (place == kReactions.end()) {
    throw MotionError(ErrorCode::kBadArgument, "an input cannot make a run do that",
                      {"let it pause, resume or stop the run"});
  }
  if (reaction.input < -1 || reaction.input >= kDigitalInputs) {
    throw MotionError(ErrorCode::kBadArgument,
                      "there is no input " + std::to_string(reaction.input) + "; inputs are 0 to " +
                          std::to_string(kDigitalInputs - 1));
  }
  motion_.reactions[static_cast<std::size_t>(place - kReactions.begin())].store(
      reaction, std::memory_order_release);
}

std::vector<LogRecord> LoopJob::log() const {
  const std::lock_guard lock(mutex_);
  return log_.records();
}

std::vector<LogRecord> LoopJob::log(std::uint64_t from, std::size_t count) const {
  const std::lock_guard lock(mutex_);
  return log_.records(from, count);
}

RunReport LoopJob::report() const {
  const std::lock_guard lock(mutex_);
  RunReport report = log_.report();
  const std::uint64_t lost = motion_.lost_records;
  report.cycles += lost;
  report.lost_records += lost;
  report.overruns = motion_.overruns;
  report.missed_cycles = motion_.missed_cycles;
  return report;
}

bool LoopJob::ended() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

void LoopJob::append(std::span<const LogRecord> records) {
  const std::lock_guard lock(mutex_);
  for (const LogRecord& record : records) log_.append(record);
}

void LoopJob::end(std::string fault) {
  {
    const std::lock_guard lock(mutex_);
    fault_ = std::move(fault);
    ended_ = true;
  }
  changed_.notify_all();
}

}  // namespace viapoint
