/// @file
/// The last look at a setpoint before the drive sees it, independent of all planning.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/core/nonblocking.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"
#include "viapoint/profile/axis_move.hpp"
#include "viapoint/realtime/drive.hpp"

namespace viapoint {

/// What the guard holds besides the joint limits.
struct GuardOptions {
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  /// Needed for what is held at the tool.
  std::optional<ForwardKinematics> kinematics;
  double tool_speed = kNone;  ///< of the tool point [m/s]; 0.25 in reduced mode (ISO 10218-1)
  /// Box in the base frame that the tool point may not leave [m].
  Eigen::Vector3d box_min = Eigen::Vector3d::Constant(-kNone);
  Eigen::Vector3d box_max = Eigen::Vector3d::Constant(kNone);
  /// How far the arm may be behind its setpoint, as the time it takes at its velocity limit [s].
  double following = 0.2;
  int silent_cycles = 10;  ///< that the drive may leave out in a row
};

/// What was found wrong.
struct Breach {
  enum class Kind : std::uint8_t {
    kNone,
    // Of the setpoint: the path is lost, each joint stops by itself.
    kNotFinite,
    kPosition,
    kCoupling,
    kVelocity,
    kAcceleration,
    kJerk,
    kDerivatives,  ///< velocities that do not belong to the positions
    // Of what the path can still be held for: the arm stops on it.
    kBox,
    kToolSpeed,
    kFollowing,  ///< the arm is too far from its setpoint
    kEncoder,    ///< what is measured jumps
    kSilent,     ///< the drive does not answer
    kGuided,     ///< a hand moves the arm, which was told to move
    // The drive's own: nothing is told it any more.
    kDrive,
    kPowerLost,
  };
  Kind kind = Kind::kNone;
  int index = -1;  ///< joint, row of the coupling, or axis of the box, from 0
  double value = 0.0, limit = 0.0;

  [[nodiscard]] bool any() const noexcept { return kind != Kind::kNone; }
  /// False where the arm stops, or has stopped, off its path.
  [[nodiscard]] bool path_is_held() const noexcept {
    return kind >= Kind::kBox && kind <= Kind::kGuided;
  }
};

/// One sentence; empty for none.
[[nodiscard]] std::string text_of(const Breach& breach);

/// Holds every setpoint against the one before it. Within a cycle of h a motion that keeps its
/// limits V, A, J changes by no more than hV, hA, hJ in q, q̇, q̈; and by the trapezoid's rule with
/// its error term (Davis & Rabinowitz 1984, 2.1) its positions belong to its velocities:
/// |Δq - h (q̇₀ + q̇₁)/2| <= h³J/12. So no polynomial is needed, and nothing of what made the
/// setpoint. A joint outside its position limits may come in, and so may a coupled one.
///
/// The first breach is kept. Where the path is lost the guard brings every joint to rest by the
/// quickest law from the last setpoint that passed, and tells those setpoints in place of the
/// motion's.
///
/// Real-time: all but the constructor is safe. Threads: one.
class Guard {
 public:
  /// @param start where the arm rests. @pre limits valid
  Guard(const JointLimits& limits, std::chrono::nanoseconds cycle, const GuardOptions& options,
        const JointVector& start);

  enum class Verdict {
    kPass,
    kStopOnPath,  ///< the setpoint passes; the motion has to be stopped
    kOffPath,     ///< the setpoint is now one of the guard's own stop
    kAtRest,      ///< the same, and with it every joint is at rest
  };
  /// Looks at the setpoint due now, and replaces it where it must not pass.
  Verdict pass(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING;
  /// Looks at what the drive answered to it.
  /// @param late_cycles cycles that the loop has slept through before this one: the arm had that
  ///        much longer to move
  void look_at(DriveStatus status, const Measurement& measurement,
               std::int64_t late_cycles = 0) noexcept VIAPOINT_NONBLOCKING;
  /// The arm rests where a hand holds it, (n,), and so do the setpoints from now on.
  void stand_at(const JointVector& position) noexcept VIAPOINT_NONBLOCKING;
  /// A hand moves the arm, although it was told to move.
  void refuse_hand() noexcept VIAPOINT_NONBLOCKING;
  /// The first breach.
  [[nodiscard]] const Breach& breach() const noexcept { return breach_; }

 private:
  [[nodiscard]] Breach judge(const Setpoint& setpoint) const noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] Breach judge_couplings(const Setpoint& setpoint) const noexcept
      VIAPOINT_NONBLOCKING;
  [[nodiscard]] Breach judge_tool(const Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING;
  void begin_stop() noexcept VIAPOINT_NONBLOCKING;
  bool tell_stop(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING;

  JointLimits limits_;
  double cycle_;
  GuardOptions options_;
  bool holds_tool_;
  JointVector q_, qd_, qdd_;  ///< of the last setpoint that passed
  JointVector measured_;
  Eigen::Vector3d tool_ = Eigen::Vector3d::Zero();
  int silent_ = 0;
  double unseen_cycles_ = 0.0;  ///< since the arm was measured last
  Breach breach_;
  bool off_path_ = false;
  std::uint64_t stopping_ = 0;  ///< cycles since the stop began
  std::array<AxisMove, kMaxJoints> stop_;
};

}  // namespace viapoint
