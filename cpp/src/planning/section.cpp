#include "planning/section.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "planning/corner_fit.hpp"
#include "planning/path_cut.hpp"
#include "viapoint/path/tool_rates.hpp"
#include "viapoint/trajectory/time_parameterizer.hpp"

namespace viapoint::planning {
namespace {

/// A leg between two corners gives each up to half; towards a stop nearly all of it.
constexpr double kShareBetweenCorners = 0.5;
constexpr double kShareTowardsStop = 0.9;

/// Grows one section leg by leg.
class Builder {
 public:
  Builder(const RobotModel& robot, std::span<const Leg> legs) : robot_(robot), legs_(legs) {}

  std::vector<Section> build() {
    tail_ = legs_.front().path;
    for (size_t i = 0; i < legs_.size(); ++i) {
      const bool last = i + 1 == legs_.size();
      if (last || legs_[i].options.zone.kind == ZoneKind::kFine) {
        finish(i);
      } else if (!turn(i)) {
        finish(i);
      }
    }
    return std::move(sections_);
  }

 private:
  [[nodiscard]] bool has_corner_after(size_t leg) const {
    return leg + 1 < legs_.size() && legs_[leg].options.zone.kind != ZoneKind::kFine;
  }

  /// Rounds the corner between leg i and the next; false where it becomes a stop.
  bool turn(size_t i) {
    const Leg& after = legs_[i + 1];
    const double room_before = kShareTowardsStop * tail_.length();
    const double room_after =
        (has_corner_after(i + 1) ? kShareBetweenCorners : kShareTowardsStop) * after.path.length();
    Corner corner = fit_corner(robot_, legs_[i], tail_, after, room_before, room_after);
    CornerOutcome outcome;
    outcome.move = legs_[i].step;
    outcome.asked = legs_[i].options.zone;
    outcome.reason = corner.reason;
    if (!corner.possible) return stop(std::move(outcome));

    const JointPath head = cut(tail_, 0.0, tail_.length() - corner.cut_before);
    JointPath rest = cut(after.path, corner.cut_after, after.path.length());
    if (!surely_pays(corner, tail_, after.path)) {
      const double gain = gain_of(i, head, corner.blend, rest);
      if (gain <= 0.0) {
        char reason[96];
        std::snprintf(reason, sizeof reason, "stopping at the point is quicker by %.1f ms",
                      -1e3 * gain);
        outcome.reason = reason;
        return stop(std::move(outcome));
      }
    }

    append(path_, head);
    append_blend(corner.blend, legs_[i].step, after.step);
    tail_ = std::move(rest);
    outcome.used = corner.used;
    outcome.cut = corner.tool_deviation;
    corners_.push_back(std::move(outcome));
    return true;
  }

  bool stop(CornerOutcome outcome) {
    outcome.stopped = true;
    corners_.push_back(std::move(outcome));
    return false;
  }

  /// How much quicker the two legs are with the corner than with a stop [s]. Each is timed from
  /// rest to rest: the neighbours are the same in both.
  double gain_of(size_t i, const JointPath& head, const JointPiece& blend,
                 const JointPath& rest) const {
    JointPath rounded = head;
    rounded.append(blend);
    append(rounded, rest);
    const double with_stop =
        duration_of(timed(tail_).pieces) + duration_of(timed(legs_[i + 1].path).pieces);
    return with_stop - duration_of(timed(rounded).pieces);
  }

  /// From rest to rest.
  [[nodiscard]] Section timed(const JointPath& path) const {
    const auto& pieces = path.pieces();
    const bool limits_tool =
        std::any_of(pieces.begin(), pieces.end(), [](const auto& p) { return p.tool.any(); });
    Section section;
    if (!limits_tool) {
      section.pieces = parameterize(path, robot_.limits());
      return section;
    }
    const PathWithTool with_tool = with_tool_rates(robot_.forward(), path);
    TimedPath result = parameterize(with_tool.path, robot_.limits(), with_tool.rates);
    section.pieces = std::move(result.pieces);
    for (const size_t origin : result.origin) {
      section.tool.push_back(with_tool.path.pieces()[origin].tool);
    }
    return section;
  }

  static void append(JointPath& path, const JointPath& more) {
    for (const JointPiece& piece : more.pieces()) path.append(piece);
  }

  /// In two halves, so that the move under way changes in the middle of the corner.
  void append_blend(const JointPiece& blend, int step_before, int step_after) {
    JointPiece first = blend.part(0.0, 0.5 * blend.length);
    JointPiece second = blend.part(0.5 * blend.length, blend.length);
    first.move = step_before;
    second.move = step_after;
    path_.append(std::move(first));
    path_.append(std::move(second));
  }

  /// Leg i ends at rest: times what has gathered and begins anew with the next leg.
  void finish(size_t i) {
    append(path_, tail_);
    Section section = timed(path_);
    section.corners = std::move(corners_);
    sections_.push_back(std::move(section));
    path_ = JointPath();
    corners_.clear();
    if (i + 1 < legs_.size()) tail_ = legs_[i + 1].path;
  }

  const RobotModel& robot_;
  std::span<const Leg> legs_;
  std::vector<Section> sections_;
  JointPath path_;  ///< of the section under way, final
  JointPath tail_;  ///< what is left of the present leg, in the section's scale
  std::vector<CornerOutcome> corners_;
};

}  // namespace

std::vector<Section> build_sections(const RobotModel& robot, std::span<const Leg> legs) {
  return Builder(robot, legs).build();
}

double duration_of(std::span<const TrajectoryPiece> pieces) {
  double sum = 0.0;
  for (const TrajectoryPiece& piece : pieces) sum += piece.duration;
  return sum;
}

}  // namespace viapoint::planning
