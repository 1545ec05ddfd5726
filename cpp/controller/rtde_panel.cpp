#include "controller/rtde_panel.hpp"

#include "viapoint/core/error.hpp"

namespace viapoint::controller {
namespace {

const ForwardKinematics& kinematics_of(const RobotModel& robot) {
  if (robot.has_kinematics() && robot.joints() == 6) return robot.forward();
  throw MotionError(ErrorCode::kFile,
                    "RTDE tells of arms with 6 joints and a tool; \"" + robot.name() + "\" has " +
                        std::to_string(robot.joints()) + " joints" +
                        (robot.has_kinematics() ? "" : " and no kinematics"),
                    {"leave \"rtde\" out of the configuration"});
}

}  // namespace

RtdePanel::RtdePanel(ArmHost& host, const RobotModel& robot, const RtdeAddress& where,
                     std::chrono::nanoseconds cycle)
    : arm_(host),
      server_(arm_, kinematics_of(robot),
              {where.address, where.port, cycle, where.other_machines}) {}

}  // namespace viapoint::controller
