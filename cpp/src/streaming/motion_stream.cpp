#include "viapoint/streaming/motion_stream.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

namespace viapoint {
namespace {

/// With less motion than this before it, the arm is given what is certain, however little [s].
constexpr double kEnough = 1.0;
/// With less than so many times what handing over takes, steps are handed over as they come.
constexpr double kHurry = 4.0;
/// With less than this, and twice what handing over takes, it is to rest where no way is found to
/// go on without; there is no hurry before, because such a rest is where the motion ends anyway
/// [s].
constexpr double kLittle = 0.02;

bool is_over(const Progress& run) {
  const RunState state = run.state();
  return state == RunState::kStopped || state == RunState::kFinished || state == RunState::kFault;
}

/// Nobody need ask for them.
template <typename T>
void keep_newest(std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  if (to.size() <= MotionStream::kKept) return;
  to.erase(to.begin(), to.end() - static_cast<std::ptrdiff_t>(MotionStream::kKept));
}

}  // namespace

MotionStream::MotionStream(RobotPtr robot, const MotionProgram& beginning, Follow follow,
                           double margin)
    : planner_(std::move(robot), beginning),
      follow_(std::move(follow)),
      margin_(margin),
      steps_(static_cast<int>(beginning.steps.size())) {
  planner_.merge_nothing();
  if (steps_ > 0) blamed_ = {steps_ - 1, beginning.steps.back().source, 0};
}

void MotionStream::add(const Step& step) {
  require_no_trouble();
  // The first motion should see as many steps as come at this very moment.
  if (run_ != nullptr && !std::holds_alternative<SetOutput>(step.what)) hand_over(false);
  planner_.add(step);
  left_then_ = time_left();
  tried_ = Need::kNone;
  if (!awaited_) awaited_ = LateStep{steps_, step.source, 0};
  ++steps_;
  is_fresh_ = true;
  if (run_ != nullptr && is_in_hurry()) hand_over(false);
}

void MotionStream::end() {
  planner_.end();
  tried_ = Need::kNone;
  is_fresh_ = false;
  hand_over();
}

void MotionStream::hand_over() {
  if (std::exchange(is_fresh_, false) && !is_in_hurry()) return require_no_trouble();
  hand_over(true);
}

bool MotionStream::is_in_hurry() const { return time_left() < kHurry * margin_; }

void MotionStream::hand_over(bool may_rest) {
  require_no_trouble();
  try {
    hand_over_chunks(may_rest);
  } catch (...) {
    // What follows does not begin where the arm rests.
    trouble_ = std::current_exception();
    if (run_ != nullptr) run_->close();
    throw;
  }
}

void MotionStream::require_no_trouble() const {
  if (trouble_ != nullptr) std::rethrow_exception(trouble_);
}

void MotionStream::hand_over_chunks(bool may_rest) {
  for (;;) {
    if (run_ != nullptr && is_over(*run_)) return;
    if (is_offered_ && !is_decided()) return;
    const double not_before = run_ == nullptr ? 0.0 : run_->earliest_leave() + margin_;
    const double left = time_left();
    const bool is_now = may_rest && left < std::max(kLittle, 2.0 * margin_);
    const Need need = is_now ? Need::kNow : left < kEnough ? Need::kSoon : Need::kLater;
    if (tried_ >= need) return;  // and nothing has come since
    const int stops = planner_.stops();
    std::optional<MotionChunk> chunk =
        planner_.next(std::max(0.0, not_before), need >= Need::kSoon, need == Need::kNow);
    tried_ = chunk ? Need::kNone : need;
    if (chunk) blamed_ = awaited_.value_or(blamed_);
    if (chunk || need == Need::kNow) awaited_.reset();
    if (!chunk) {
      if (run_ != nullptr && planner_.done()) run_->close();
      return;
    }
    is_stop_ = planner_.stops() > stops;
    if (run_ == nullptr) {
      begin(std::move(*chunk));
    } else {
      offer(std::move(*chunk));
    }
  }
}

void MotionStream::begin(MotionChunk chunk) {
  run_ = follow_(std::make_shared<const Trajectory>(std::move(chunk.motion)));
  keep(chunk);
}

void MotionStream::keep(MotionChunk& chunk) {
  keep_newest(chunk.corners, corners_);
  keep_newest(chunk.warnings, warnings_);
}

void MotionStream::offer(MotionChunk chunk) {
  run_->lengthen(std::make_shared<const Trajectory>(std::move(chunk.motion)), chunk.begin);
  is_offered_ = true;
  keep(chunk);
}

bool MotionStream::is_decided() {
  const LinkFate fate = run_->fate();
  if (fate == LinkFate::kNotYet) return false;
  is_offered_ = false;
  if (fate == LinkFate::kTooLate && !is_over(*run_)) {
    is_stop_ = true;
    offer(planner_.after_rest());
    return is_decided();
  }
  note_late();
  return true;
}

void MotionStream::note_late() {
  const std::uint64_t waited = run_->waited_cycles() - waited_;
  waited_ += waited;
  const bool is_late = waited > 0 || (is_stop_ && left_then_ < kEnough);
  if (!is_late || last_late_ == blamed_.step) return;
  last_late_ = blamed_.step;
  ++late_count_;
  blamed_.waited_cycles = waited;
  if (late_.size() == kKept) late_.erase(late_.begin());
  late_.push_back(blamed_);
}

double MotionStream::time_left() const {
  return run_ == nullptr ? 0.0 : run_->duration() - run_->nominal_time();
}

int MotionStream::steps_ahead() const {
  return run_ == nullptr ? steps_ : steps_ - 1 - std::max(0, run_->move());
}

std::vector<CornerOutcome> MotionStream::take_corners() { return std::exchange(corners_, {}); }
std::vector<Problem> MotionStream::take_warnings() { return std::exchange(warnings_, {}); }

}  // namespace viapoint
