#include "remote/run_book.hpp"

#include <string>
#include <utility>

#include "viapoint/core/error.hpp"

namespace viapoint {

bool has_ended(const Job& job) {
  const RunState state = job.state();
  return state == RunState::kFinished || state == RunState::kStopped || state == RunState::kFault;
}

std::uint64_t RunBook::add(KeptRun run) {
  runs_.push_back(std::move(run));
  if (runs_.size() > kept_) runs_.pop_front();
  return ++last_;
}

std::size_t RunBook::place_of(std::uint64_t number) const {
  if (number <= last_ && last_ - number < runs_.size()) {
    return runs_.size() - 1 - static_cast<std::size_t>(last_ - number);
  }
  throw MotionError(ErrorCode::kBadArgument, "run " + std::to_string(number) +
                                                 " is not known; the last one is " +
                                                 std::to_string(last_) + ", and the newest " +
                                                 std::to_string(kept_) + " are kept");
}

}  // namespace viapoint
