#include "viapoint/realtime/input_gate.hpp"

#include <algorithm>

namespace viapoint {
namespace {

/// Nearer than this a time-out is reached [s].
constexpr double kSlack = 1e-9;

}  // namespace

void InputGate::begin(const Trajectory& motion) noexcept VIAPOINT_NONBLOCKING {
  motion_ = &motion;
  next_ = 0;
  waits_ = false;
}

void InputGate::lengthen(const Trajectory& motion,
                         std::size_t dropped) noexcept VIAPOINT_NONBLOCKING {
  const auto& before = motion_->waits();
  const auto kept = std::ranges::lower_bound(before, dropped);
  next_ -= std::min(next_, static_cast<std::size_t>(kept - before.begin()));
  motion_ = &motion;
}

double InputGate::place() const noexcept VIAPOINT_NONBLOCKING {
  const auto& waits = motion_->waits();
  if (next_ >= waits.size()) return std::numeric_limits<double>::infinity();
  return motion_->start_of(waits[next_]);
}

void InputGate::arrive() noexcept VIAPOINT_NONBLOCKING {
  waits_ = true;
  cycles_ = 0;
  wait_ = motion_->pieces()[motion_->waits()[next_]].wait;
}

InputGate::Answer InputGate::ask(std::uint64_t inputs) noexcept VIAPOINT_NONBLOCKING {
  if (wait_.is_met_by(inputs)) {
    ++next_;
    waits_ = false;
    return Answer::kGoOn;
  }
  const double waited = static_cast<double>(cycles_++) * cycle_;
  return waited + kSlack >= wait_.timeout ? Answer::kTimedOut : Answer::kWait;
}

}  // namespace viapoint
