// What a step tells in a frame, told in the base frame.
#include <utility>

#include "viapoint/program/motion_program.hpp"

namespace viapoint {
namespace {

struct Mover {
  const Pose& pose_base_frame;

  void move(Target& target) const {
    if (auto* pose = std::get_if<PoseTarget>(&target)) {
      pose->pose_base_tool = pose_base_frame * pose->pose_base_tool;
    } else if (auto* point = std::get_if<PositionTarget>(&target)) {
      point->position = pose_base_frame * point->position;
    }
  }

  void operator()(PtpMove& step) const { move(step.target); }
  void operator()(LinMove& step) const { move(step.target); }
  void operator()(CircMove& step) const {
    move(step.via);
    move(step.target);
  }
  void operator()(TurnMove& step) const {
    if (step.center) step.center = pose_base_frame * *step.center;
    if (step.axis) step.axis = pose_base_frame.linear() * *step.axis;
  }
  void operator()(SplineMove& step) const {
    for (Target& point : step.points) move(point);
    if (step.start) move(*step.start);
  }
  void operator()(TimedMove& step) const {
    for (TimedPoint& point : step.points) move(point.target);
  }
  void operator()(const Wait&) const {}
  void operator()(const WaitInput&) const {}
  void operator()(const SetOutput&) const {}
  void operator()(const SetFrame&) const {}
  void operator()(const SetTool&) const {}
};

}  // namespace

Step in_base(Step step, const Pose& pose_base_frame) {
  // Left to the last bit as it is where the frame is the base itself.
  if (pose_base_frame.matrix() == Eigen::Matrix4d::Identity()) return step;
  std::visit(Mover{pose_base_frame}, step.what);
  return step;
}

}  // namespace viapoint
