#include "viapoint/streaming/motion_stream.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace viapoint {
namespace {

/// With less motion than this before it, the arm is given what is certain, however little [s].
constexpr double kEnough = 1.0;
/// With less than this, and twice what handing over takes, it is to rest where no way is found to
/// go on without; there is no hurry before, because such a rest is where the motion ends anyway
/// [s].
constexpr double kLittle = 0.02;

bool is_over(const Job& job) {
  const RunState state = job.state();
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
  planner_.add(step);
  left_then_ = time_left();
  tried_ = Need::kNone;
  if (!awaited_) awaited_ = LateStep{steps_, step.source, 0};
  ++steps_;
  // The next one may come at this very moment; the first motion should see as many as do.
  if (job_ != nullptr) hand_over(false);
}

void MotionStream::end() {
  planner_.end();
  tried_ = Need::kNone;
  hand_over();
}

void MotionStream::hand_over() { hand_over(true); }

void MotionStream::hand_over(bool may_rest) {
  require_no_trouble();
  try {
    hand_over_chunks(may_rest);
  } catch (...) {
    // What follows does not begin where the arm rests.
    trouble_ = std::current_exception();
    if (job_ != nullptr) job_->close();
    throw;
  }
}

void MotionStream::require_no_trouble() const {
  if (trouble_ != nullptr) std::rethrow_exception(trouble_);
}

void MotionStream::hand_over_chunks(bool may_rest) {
  for (;;) {
    if (job_ != nullptr && is_over(*job_)) return;
    if (is_offered_ && !is_decided()) return;
    const double not_before = job_ == nullptr ? 0.0 : job_->earliest_leave() + margin_;
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
      if (job_ != nullptr && planner_.done()) job_->close();
      return;
    }
    is_stop_ = planner_.stops() > stops;
    if (job_ == nullptr) {
      begin(std::move(*chunk));
    } else {
      offer(std::move(*chunk));
    }
  }
}

void MotionStream::begin(MotionChunk chunk) {
  job_ = follow_(std::make_shared<const Trajectory>(std::move(chunk.motion)));
  keep(chunk);
}

void MotionStream::keep(MotionChunk& chunk) {
  keep_newest(chunk.corners, corners_);
  keep_newest(chunk.warnings, warnings_);
}

void MotionStream::offer(MotionChunk chunk) {
  job_->lengthen(std::make_shared<const Trajectory>(std::move(chunk.motion)), chunk.begin);
  is_offered_ = true;
  keep(chunk);
}

bool MotionStream::is_decided() {
  const LinkFate fate = job_->fate();
  if (fate == LinkFate::kNotYet) return false;
  is_offered_ = false;
  if (fate == LinkFate::kTooLate && !is_over(*job_)) {
    is_stop_ = true;
    offer(planner_.after_rest());
    return is_decided();
  }
  note_late();
  return true;
}

void MotionStream::note_late() {
  const std::uint64_t waited = job_->waited_cycles() - waited_;
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
  return job_ == nullptr ? 0.0 : job_->duration() - job_->nominal_time();
}

int MotionStream::steps_ahead() const {
  return job_ == nullptr ? steps_ : steps_ - 1 - std::max(0, job_->move());
}

std::vector<CornerOutcome> MotionStream::take_corners() { return std::exchange(corners_, {}); }
std::vector<Problem> MotionStream::take_warnings() { return std::exchange(warnings_, {}); }

}  // namespace viapoint
