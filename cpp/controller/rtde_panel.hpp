/// @file
#pragma once

#include <chrono>
#include <cstdint>

#include "controller/config.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/remote/arm_host.hpp"
#include "viapoint/rtde/rtde_arm.hpp"
#include "viapoint/rtde/rtde_server.hpp"

namespace viapoint::controller {

/// Shows the host's arm to RTDE clients, and lets them turn its override and switch its outputs,
/// whoever is the operator. Threads: any.
class RtdePanel {
 public:
  /// @param host outlives the panel
  /// @throws MotionError(kFile) for a robot without kinematics; as RtdeServer
  RtdePanel(ArmHost& host, const RobotModel& robot, const RtdeAddress& where,
            std::chrono::nanoseconds cycle);

  [[nodiscard]] int port() const { return server_.port(); }

 private:
  class Arm final : public RtdeArm {
   public:
    explicit Arm(ArmHost& host) : host_(host) {}
    [[nodiscard]] LoopCycle newest_cycle() override { return host_.newest_cycle(); }
    void set_override(double share) override { host_.set_override(share); }
    void switch_outputs(std::uint64_t mask, std::uint64_t values) override {
      host_.switch_outputs(mask, values);
    }

   private:
    ArmHost& host_;
  };

  Arm arm_;
  RtdeServer server_;
};

}  // namespace viapoint::controller
