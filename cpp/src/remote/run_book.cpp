#include "remote/run_book.hpp"

#include <algorithm>
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

void RunBook::add_tools(std::uint64_t number, const std::vector<ToolChange>& changes) {
  std::vector<ToolChange>& tools = runs_[place_of(number)].tools;
  if (changes.size() > kMaxTools - tools.size()) {
    throw MotionError(ErrorCode::kBadArgument, "a run changes tools " +
                                                   std::to_string(tools.size() + changes.size()) +
                                                   " times; kept are " + std::to_string(kMaxTools));
  }
  tools.insert(tools.end(), changes.begin(), changes.end());
}

std::vector<ToolChange> RunBook::tools(std::uint64_t number, std::size_t offset,
                                       std::size_t most) const {
  const std::vector<ToolChange>& tools = find(number).tools;
  const std::size_t begin = std::min(offset, tools.size());
  const std::size_t end = begin + std::min(most, tools.size() - begin);
  return {tools.begin() + static_cast<std::ptrdiff_t>(begin),
          tools.begin() + static_cast<std::ptrdiff_t>(end)};
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
