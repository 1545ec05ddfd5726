#include "viapoint/planning/stream_planner.hpp"

#include <algorithm>
#include <deque>
#include <iterator>
#include <utility>
#include <variant>

#include "planning/itinerary.hpp"
#include "planning/motion_parts.hpp"
#include "planning/path_timer.hpp"
#include "planning/pending_outputs.hpp"
#include "planning/section.hpp"
#include "planning/section_builder.hpp"
#include "planning/told_steps.hpp"
#include "planning/tool_proof.hpp"

namespace viapoint {
namespace {

using planning::Dwell;
using planning::Item;
using planning::Leg;
using planning::SectionPart;

/// Legs that the first chunk of a section has at least, and that every later one brings: few at
/// first, so that motion begins soon.
constexpr int kFirstLegs = 3;
constexpr int kMostLegs = 24;
/// Pieces of path that a chunk goes on by at most.
constexpr size_t kMostPieces = 96;

/// A part of a section, or a rest, of one arm.
struct Stage {
  RobotPtr arm;
  std::variant<SectionPart, TrajectoryPiece> what;
};

}  // namespace

class StreamPlanner::Line {
 public:
  Line(RobotPtr robot, const MotionProgram& program)
      : arm_(robot), at_(program.start), walk_(std::move(robot), program) {
    if (!walk_.begun()) throw MotionError(walk_.found().report.problems.front());
    builder_.emplace(*arm_);
    for (const Step& step : program.steps) add(step);
  }

  void add(const Step& step) {
    if (ended_) {
      throw MotionError(ErrorCode::kBadProgram, "the program has ended: no step can follow",
                        {"begin another stream where this one ends"});
    }
    const int index = steps_++;
    told_.add(index, step.source);
    walk_.take(step, index);
    if (auto problem = take_found()) {
      end();
      throw MotionError(std::move(*problem));
    }
  }

  void merge_nothing() {
    walk_.merge_nothing();
    (void)take_found();  // no step, no error
  }

  void end() {
    if (ended_) return;
    ended_ = true;
    walk_.end();
    (void)take_found();  // no step, no error
    rest_here();
  }

  std::optional<MotionChunk> next(double not_before, bool at_once, bool may_rest) {
    collect();
    if (ready_.empty()) return timer_ ? std::nullopt : at_last();
    if (std::holds_alternative<TrajectoryPiece>(ready_.front().what)) return rest();
    return motion(not_before, at_once, may_rest);
  }

  MotionChunk after_rest() {
    outputs_.miss();
    last_ = std::move(before_);
    duration_ = duration_before_;
    planning::PathTimer& timer = timer_ ? *timer_ : *over_;
    timer.begin_after_missing();
    ++stops_;
    MotionChunk chunk;
    chunk.begin = duration_;
    followed_ = true;  // of the one that was missed nothing is run
    finish(chunk, section_arm_, timer.timing().pieces, !timer_, timer.tool());
    chunk.last = handed_out_last_ = is_last();
    return chunk;
  }

  [[nodiscard]] bool done() const { return ended_ && handed_out_last_; }
  [[nodiscard]] int stops() const { return stops_; }

 private:
  /// Takes over what the steps so far came to. @returns the first error
  std::optional<Problem> take_found() {
    planning::Itinerary found = walk_.found();
    for (Item& item : found.items) take(std::move(item));
    std::optional<Problem> error;
    for (Problem& problem : found.report.problems) {
      if (problem.severity != Severity::kError) {
        warnings_.push_back(std::move(problem));
      } else if (!error) {
        error = std::move(problem);
      }
    }
    return error;
  }

  void take(Item item) {
    if (auto* leg = std::get_if<Leg>(&item)) {
      if (leg->robot != arm_) change_tool(leg->robot);
      told_.note(*leg);
      zone_ = leg->options.zone;
      last_leg_ = leg->step;
      at_ = leg->goal;
      builder_->add(std::move(*leg));
    } else if (const auto* dwell = std::get_if<Dwell>(&item)) {
      rest_here();
      if (dwell->seconds >= planning::kShortestWait) {
        ready_.push_back({arm_, planning::rest_at(at_, *dwell)});
      }
    } else {
      outputs_.add(std::get<planning::Output>(std::move(item)));
    }
  }

  /// A zone is a promise about one tool point, so the arm rests where the tool changes.
  void change_tool(const RobotPtr& arm) {
    if (last_leg_ >= 0 && zone_.kind != ZoneKind::kFine) {
      tool_changes_.push_back(planning::stop_for_tool(last_leg_, zone_));
    }
    rest_here();
    arm_ = arm;
    builder_.emplace(*arm_);
  }

  void rest_here() {
    builder_->end();
    last_leg_ = -1;
    collect();
  }

  void collect() {
    for (SectionPart& part : builder_->take()) {
      auto* open = ready_.empty() ? nullptr : std::get_if<SectionPart>(&ready_.back().what);
      if (open == nullptr || open->ends) {
        ready_.push_back({arm_, std::move(part)});
      } else {
        for (const JointPiece& piece : part.path.pieces()) open->path.append(piece);
        open->corners.insert(open->corners.end(), part.corners.begin(), part.corners.end());
        open->ends = part.ends;
      }
    }
  }

  /// All there is of the section under way, as far as one window goes, if that is enough.
  std::optional<MotionChunk> motion(double not_before, bool at_once, bool may_rest) {
    auto& part = std::get<SectionPart>(ready_.front().what);
    const size_t left = part.path.pieces().size() - used_;
    const bool all = left <= kMostPieces;
    const bool ends = all && part.ends;
    const auto legs = std::count_if(part.corners.begin(), part.corners.end(),
                                    [](const auto& corner) { return !corner.merged_into; });
    if (all && !ends && legs < (at_once ? 1 : wanted_legs_)) return std::nullopt;
    if (!timer_) {
      section_arm_ = ready_.front().arm;
      timer_.emplace(*section_arm_);
      section_begun_ = false;
    }
    const auto from = part.path.pieces().begin() + static_cast<std::ptrdiff_t>(used_);
    const size_t count = std::min(left, kMostPieces);
    JointPath window;
    std::for_each_n(from, count, [&](const JointPiece& piece) { window.append(piece); });
    planning::PathTimer later = *timer_;
    later.append(window);
    const double leave = later.extend(all && !ends ? builder_->certain() : JointPath(), not_before);
    if (!may_rest && later.stops() > timer_->stops()) return std::nullopt;
    stops_ += later.stops() - timer_->stops();
    timer_.emplace(std::move(later));

    MotionChunk chunk;
    used_ += count;
    chunk.corners = std::exchange(part.corners, {});
    if (all) {
      ready_.pop_front();
      used_ = 0;
    }
    chunk.begin = section_begun_ ? leave : duration_;
    section_begun_ = true;
    wanted_legs_ = ends ? kFirstLegs : std::min(kMostLegs, 2 * wanted_legs_);
    finish(chunk, section_arm_, timer_->timing().pieces, ends, timer_->tool());
    if (ends) {
      follow_process(duration_);
      over_.emplace(std::move(*timer_));
      timer_.reset();
      chunk.corners.insert(chunk.corners.end(), tool_changes_.begin(), tool_changes_.end());
      tool_changes_.clear();
    }
    warn_of(chunk);
    return chunk;
  }

  MotionChunk rest() {
    MotionChunk chunk;
    chunk.begin = duration_;
    const Stage stage = std::move(ready_.front());
    ready_.pop_front();
    finish(chunk, stage.arm, {std::get<TrajectoryPiece>(stage.what)}, true);
    warn_of(chunk);
    return chunk;
  }

  /// What is left when all motion has been handed out: outputs that change at the end, and a short
  /// rest where the program does not move at all.
  std::optional<MotionChunk> at_last() {
    if (!ended_ || handed_out_last_) return std::nullopt;
    if (steps_ > 0) outputs_.leave(last_, duration_);
    if (steps_ == 0 || (handed_out_ && outputs_.none_left())) {
      handed_out_last_ = true;  // before the end was known
      return std::nullopt;
    }
    std::vector<TrajectoryPiece> pieces;
    const size_t rests =
        std::max<size_t>(1, (outputs_.count() + kMaxOutputsAPiece - 1) / kMaxOutputsAPiece);
    for (size_t k = 0; k < rests; ++k) {
      pieces.push_back(planning::rest_at(at_, planning::kLastOutputs, steps_));
    }
    pieces.back().duration += outputs_.latest();
    MotionChunk chunk;
    chunk.begin = duration_;
    finish(chunk, arm_, std::move(pieces), true);
    warn_of(chunk);
    return chunk;
  }

  /// Looks for process speeds that are not held in the chunk handed out last, run until `end`.
  void follow_process(double end) {
    if (std::exchange(followed_, true)) return;
    std::vector<TrajectoryPiece> run;
    planning::append_until(run, last_, end);
    time_ = planning::add_process(process_, *last_arm_, run, last_tool_, time_);
  }

  /// @param move_ends a move ends with the last piece
  void finish(MotionChunk& chunk, const RobotPtr& of, std::vector<TrajectoryPiece> pieces,
              bool move_ends, std::vector<ToolLimits> tool = {}) {
    const RobotModel& arm = *of;
    outputs_.leave(last_, chunk.begin);
    follow_process(chunk.begin);
    // A stretch may be told one chunk after its move.
    if (!last_.empty()) told_.drop_before(last_.front().move);
    outputs_.attach(pieces, tool,
                    {.from_start = !handed_out_,
                     .to_end = ended_ && ready_.empty() && !timer_,
                     .move_ends = move_ends});
    const std::optional<JointState> from = state_at(chunk.begin);
    const double manipulability = planning::least_manipulability(arm, pieces);
    chunk.motion = Trajectory(std::move(pieces), arm.limits(), from);
    outputs_.hand_out(chunk.motion, duration_ - chunk.begin);
    duration_before_ = std::exchange(duration_, chunk.motion.duration());
    before_ = std::exchange(last_, chunk.motion.pieces());

    Certificate& certificate = chunk.motion.certificate();
    certificate.manipulability = manipulability;
    planning::ToolProof proof;
    if (!tool.empty()) proof.add(arm, chunk.motion.pieces(), tool, 0.0);
    certificate.tool = proof.extrema();
    for (Problem& problem : planning::problems_of(certificate.tool)) {
      certificate.problems.push_back(std::move(problem));
    }
    last_arm_ = of;
    last_tool_ = std::move(tool);
    followed_ = false;
    told_.add_deviations(certificate, chunk.motion.pieces().front().move,
                         chunk.motion.pieces().back().move);
    for (const CornerOutcome& corner : chunk.corners) {
      certificate.zone_deviation = std::max(certificate.zone_deviation, corner.cut);
    }
    for (Problem problem : certificate.problems) {
      told_.locate(problem);
      throw MotionError(std::move(problem));
    }
    handed_out_ = true;
  }

  /// The state of the chunk handed out last at a time of it; nothing before the first one.
  [[nodiscard]] std::optional<JointState> state_at(double time) const {
    if (last_.empty()) return std::nullopt;
    size_t k = 0;
    for (; k + 1 < last_.size() && time >= last_[k].duration; ++k) time -= last_[k].duration;
    return last_[k].at(std::min(time, last_[k].duration));
  }

  void warn_of(MotionChunk& chunk) {
    chunk.warnings = std::exchange(warnings_, {});
    for (const CornerOutcome& corner : chunk.corners) {
      if (corner.reason.empty()) continue;
      Problem problem = planning::warning_of(corner);
      problem.move = corner.move;
      told_.locate(problem);
      chunk.warnings.push_back(std::move(problem));
    }
    chunk.process_stretches = timer_ ? process_.take_ended() : process_.take();
    for (const ProcessStretch& stretch : chunk.process_stretches) {
      Problem problem = planning::warning_of(stretch);
      problem.move = stretch.move;
      told_.locate(problem);
      chunk.warnings.push_back(std::move(problem));
    }
    chunk.last = handed_out_last_ = is_last();
  }

  [[nodiscard]] bool is_last() const {
    return ended_ && ready_.empty() && !timer_ && outputs_.all_come();
  }

  RobotPtr arm_;    ///< with the tool of the steps that come
  JointVector at_;  ///< where the last step ends
  planning::ItineraryWalk walk_;
  std::optional<planning::SectionBuilder> builder_;
  int steps_ = 0;
  bool ended_ = false;
  int last_leg_ = -1;  ///< since the arm rested
  Zone zone_;          ///< of it

  std::deque<Stage> ready_;  ///< decided, not handed out
  size_t used_ = 0;          ///< pieces of path of the first that have been handed out
  planning::PendingOutputs outputs_;
  planning::ToldSteps told_;  ///< those not passed yet
  std::vector<Problem> warnings_;
  std::vector<CornerOutcome> tool_changes_;

  std::optional<planning::PathTimer> timer_;  ///< of the section under way
  std::optional<planning::PathTimer> over_;   ///< of the one that ended with the last chunk
  RobotPtr section_arm_;
  bool section_begun_ = false;
  int wanted_legs_ = kFirstLegs;
  int stops_ = 0;

  bool handed_out_ = false, handed_out_last_ = false;
  double duration_ = 0.0;              ///< of the chunk handed out last
  std::vector<TrajectoryPiece> last_;  ///< its pieces
  std::vector<ToolLimits> last_tool_;  ///< what they allow the tool
  RobotPtr last_arm_;
  bool followed_ = true;            ///< its process speeds have been looked at
  double time_ = 0.0;               ///< up to where they were [s from the first one's beginning]
  planning::ProcessProof process_;  ///< of all chunks up to there
  // Of the chunk before, for when that one is run to its end.
  double duration_before_ = 0.0;
  std::vector<TrajectoryPiece> before_;
};

StreamPlanner::StreamPlanner(RobotPtr robot, const MotionProgram& program)
    : line_(std::make_unique<Line>(std::move(robot), program)) {}
StreamPlanner::~StreamPlanner() = default;
StreamPlanner::StreamPlanner(StreamPlanner&&) noexcept = default;
StreamPlanner& StreamPlanner::operator=(StreamPlanner&&) noexcept = default;

void StreamPlanner::add(const Step& step) { line_->add(step); }
void StreamPlanner::merge_nothing() { line_->merge_nothing(); }
void StreamPlanner::end() { line_->end(); }
std::optional<MotionChunk> StreamPlanner::next(double not_before, bool at_once, bool may_rest) {
  return line_->next(not_before, at_once, may_rest);
}
MotionChunk StreamPlanner::after_rest() { return line_->after_rest(); }
bool StreamPlanner::done() const { return line_->done(); }
int StreamPlanner::stops() const { return line_->stops(); }

}  // namespace viapoint
