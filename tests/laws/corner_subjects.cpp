#include "corner_subjects.hpp"

#include <stdexcept>
#include <utility>

#include "planning/planner_fixture.hpp"
#include "viapoint/path/insertion.hpp"
#include "viapoint/path/task_curve.hpp"

namespace viapoint::laws {
namespace {

using namespace testing_planner;

/// One piece of the leg after, its parameter stretched so that q' is continuous.
JointPiece stretched(JointPiece piece, double scale) {
  piece.length *= scale;
  return piece;
}

CornerCase rounded(RobotPtr arm, JointPath before, JointPath after, Zone zone) {
  const ForwardKinematics* chain = arm ? &arm->forward() : nullptr;
  Corner corner =
      round_corner(chain, before, after, zone, 0.5 * before.length(), 0.5 * after.length());
  if (!corner.possible) throw std::logic_error("no corner: " + corner.reason);

  JointPath path;
  const double leave = before.length() - corner.cut_before;
  for (size_t i = 0; i < before.pieces().size() && before.start_of(i) < leave; ++i) {
    const JointPiece& piece = before.pieces()[i];
    path.append(piece.part(0.0, std::min(piece.length, leave - before.start_of(i))));
  }
  path.append(corner.blend);
  for (size_t i = after.piece_at(corner.cut_after); i < after.pieces().size(); ++i) {
    const JointPiece& piece = after.pieces()[i];
    const double from = std::max(0.0, corner.cut_after - after.start_of(i));
    path.append(stretched(piece.part(from, piece.length), corner.scale_after));
  }
  return {std::move(arm), std::move(before), std::move(after),
          zone,           std::move(corner), std::move(path)};
}

JointPath line(const JointVector& from, const JointVector& to, double length = 1.0) {
  JointPath path;
  path.append(JointPiece::line(from, to, length));
  return path;
}

JointPath tool_line(const RobotModel& arm, const JointVector& from, const Pose& to) {
  const LineCurve curve(arm.forward().pose(from), to);
  JointPath path;
  for (JointPiece& piece : insert_curve(arm.forward(), arm.limits(), curve, from, {}).pieces) {
    path.append(std::move(piece));
  }
  return path;
}

CornerCase between_joint_lines() {
  return rounded(nullptr, line(puma_a(), puma_b()), line(puma_b(), puma_c()),
                 {ZoneKind::kJointDeviation, 0.05});
}

CornerCase between_lines_of_unlike_parameters() {
  return rounded(nullptr, line(puma_a(), puma_b(), 0.2), line(puma_b(), puma_c(), 7.0),
                 {ZoneKind::kJointDeviation, 0.01});
}

CornerCase between_joint_lines_at_the_tool() {
  return rounded(robot("puma560"), line(puma_a(), puma_b()), line(puma_b(), puma_c()),
                 {ZoneKind::kRadius, 0.1});
}

CornerCase between_tool_lines() {
  const RobotPtr puma = robot("puma560");
  const JointVector start = degrees({0, 25, 0, 15, 50, 10});
  Pose middle = puma->forward().pose(start);
  middle.translation() += Eigen::Vector3d(0.1, 0.05, 0.0);
  Pose end = middle;
  end.translation() += Eigen::Vector3d(0.0, 0.1, -0.08);
  JointPath before = tool_line(*puma, start, middle);
  const JointVector corner = before.at(before.length()).q;
  JointPath after = tool_line(*puma, corner, end);
  return rounded(puma, std::move(before), std::move(after), {ZoneKind::kRadius, 0.02});
}

}  // namespace

std::vector<Subject<CornerCase>> corners() {
  return {
      {"CornerBetweenJointLines", between_joint_lines},
      {"CornerBetweenLinesOfUnlikeParameters", between_lines_of_unlike_parameters},
      {"CornerBetweenJointLinesAtTheTool", between_joint_lines_at_the_tool},
      {"CornerBetweenToolLines", between_tool_lines},
  };
}

}  // namespace viapoint::laws
