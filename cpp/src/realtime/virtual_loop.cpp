#include "viapoint/realtime/virtual_loop.hpp"

#include <utility>

#include "realtime/run_desk.hpp"

namespace viapoint {

VirtualLoop::VirtualLoop(std::unique_ptr<Drive> drive, const JointLimits& limits,
                         const LoopOptions& options)
    : desk_(std::make_unique<RunDesk>(std::move(drive), limits, options,
                                      std::make_unique<VirtualClock>())) {}
VirtualLoop::~VirtualLoop() = default;
VirtualLoop::VirtualLoop(VirtualLoop&&) noexcept = default;
VirtualLoop& VirtualLoop::operator=(VirtualLoop&&) noexcept = default;

int VirtualLoop::pass(int cycles) {
  const std::shared_ptr<LoopJob> job = desk_->job();
  const bool runs = busy();
  int passed = 0;
  while (passed < cycles || passed == 0) {
    desk_->runner().cycle();
    desk_->see_to();
    ++passed;
    if (desk_->jogs() || desk_->is_guided()) continue;
    if (!runs || job->ended()) break;
    const RunState state = job->state();
    if (state == RunState::kPaused || state == RunState::kWaiting) break;
  }
  return passed;
}

std::shared_ptr<Job> VirtualLoop::run(std::shared_ptr<const Trajectory> trajectory) {
  return desk_->run(std::move(trajectory), false);
}

std::shared_ptr<OpenJob> VirtualLoop::follow(std::shared_ptr<const Trajectory> first) {
  return desk_->run(std::move(first), true);
}

void VirtualLoop::jog(const JointVector& velocity) { desk_->jog(velocity); }
void VirtualLoop::admit_hand(const std::function<void(const Measurement&)>& take) {
  desk_->admit_hand(take);
}
bool VirtualLoop::jogging() const { return desk_->jogs(); }
std::string VirtualLoop::jog_block() const {
  return text_of(desk_->channels().jog_block.load(std::memory_order_relaxed));
}
void VirtualLoop::set_override(double share) { desk_->set_override(share); }
double VirtualLoop::override_share() const {
  return desk_->channels().override_share.load(std::memory_order_relaxed);
}
void VirtualLoop::switch_outputs(std::uint64_t mask, std::uint64_t values) {
  desk_->channels().switches.set(mask, values);
}
Measurement VirtualLoop::measured() const { return desk_->channels().snapshot.read().measurement; }
LoopCycle VirtualLoop::newest_cycle() const { return desk_->channels().snapshot.read(); }
std::vector<ObservedCycle> VirtualLoop::observed(std::uint64_t from, std::size_t most) const {
  return desk_->channels().tape.read(from, most);
}
bool VirtualLoop::guided() const { return desk_->is_guided(); }
bool VirtualLoop::busy() const {
  const auto job = desk_->job();
  return job != nullptr && !job->ended();
}
JointVector VirtualLoop::position() const { return desk_->channels().snapshot.read().q; }
std::string VirtualLoop::fault() const { return desk_->fault(); }
void VirtualLoop::require_power() const { desk_->require_power(); }
std::vector<LogRecord> VirtualLoop::fault_cycles() const { return desk_->fault_cycles(); }

}  // namespace viapoint
