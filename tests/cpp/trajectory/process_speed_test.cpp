#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "path/random_arms.hpp"
#include "problem_count.hpp"
#include "trajectory/time_parameterizer_problems.hpp"
#include "viapoint/path/tool_rates.hpp"
#include "viapoint/trajectory/certificate.hpp"
#include "viapoint/trajectory/time_parameterizer.hpp"
#include "viapoint/trajectory/tool_certificate.hpp"

namespace viapoint::testing {
namespace {

double tool_speed(const ForwardKinematics& arm, const JointState& state) {
  return (arm.jacobian(arm.frames(state.q)).topRows<3>() * state.qd).norm();
}

TEST(ProcessSpeed, IsHeldWhereTheLimitsAllowItAndNeverExceeded) {
  double held_way = 0.0, whole_way = 0.0;
  int count = 0, with_hold = 0;
  for (std::uint64_t seed = 0; seed < problems(120U); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const int joints = 3 + static_cast<int>(seed % 5);
    const ForwardKinematics arm = random_arm(random, joints);
    const JointLimits limits = random_limits(random, joints, 0.3);
    const JointPath plain =
        seed % 2 == 0
            ? cornered_path(random_walk(random, joints, 1 + static_cast<int>(seed % 3), 0.1, 0.5),
                            decades(random, 1e-3, 0.1))
            : random_spline(random, joints, 1 + static_cast<int>(seed % 2),
                            decades(random, 0.05, 0.3), decades(random, 0.1, 0.5));
    const double speed = decades(random, 0.01, 1.0);
    JointPath path;
    for (JointPiece piece : plain.pieces()) {
      piece.tool.speed = speed;
      piece.tool.hold_speed = true;
      path.append(piece);
    }
    const PathWithTool with_tool = with_tool_rates(arm, path);
    const TimedPath timed = parameterize(with_tool.path, limits, with_tool.rates);
    const Certificate certificate = certify(timed.pieces, limits);
    ASSERT_TRUE(certificate.holds()) << certificate.problems.front().describe();
    double held = 0.0;
    for (size_t k = 0; k < timed.pieces.size(); ++k) {
      const TrajectoryPiece& piece = timed.pieces[k];
      const SpeedRange range = tool_speed_range(piece.timing, piece.duration,
                                                with_tool.rates[timed.origin[k]].linear, speed);
      const bool holds = range.least >= speed * (1.0 - kHeldWithin);
      double way = 0.0;
      for (int i = 0; i <= 20; ++i) {
        const double v = tool_speed(arm, piece.at(piece.duration * i / 20.0));
        ASSERT_LE(v, speed * (1.0 + 1e-9));
        ASSERT_LE(v, range.most * (1.0 + 1e-12));
        ASSERT_GE(v, range.least * (1.0 - 1e-12));
        way += v * piece.duration / 21.0;
      }
      whole_way += way / speed;
      if (holds) held_way += way / speed, held += way;
    }
    ++count;
    with_hold += held > 0.0 ? 1 : 0;
  }
  // Most of the way most of these speeds can be held.
  EXPECT_GE(held_way, 0.5 * whole_way);
  EXPECT_GE(with_hold, count / 2);
}

TEST(ProcessSpeed, IsLeftNoLongerThanARampTakes) {
  // A gantry: the tool goes where its joints go.
  std::vector<ChainJoint> chain(3);
  for (ChainJoint& joint : chain) joint.type = JointType::kPrismatic;
  chain[1].axis = Eigen::Vector3d::UnitX();
  chain[2].axis = Eigen::Vector3d::UnitY();
  const ForwardKinematics arm(chain, Pose::Identity());
  const JointLimits limits = limits_of(JointVector::Constant(3, 1.0), JointVector::Constant(3, 2.0),
                                       JointVector::Constant(3, 20.0));
  JointVector goal(3);
  goal << 0.0, 0.5, 0.0;
  JointPath path;
  JointPiece piece = JointPiece::line(JointVector::Zero(3), goal, 0.5);
  piece.tool.speed = 0.1;
  piece.tool.hold_speed = true;
  path.append(piece);
  const PathWithTool with_tool = with_tool_rates(arm, path);
  const TimedPath timed = parameterize(with_tool.path, limits, with_tool.rates);
  // From rest to 0.1 m/s: two phases of jerk of √(0.1 / 20) s each.
  const double ramp = 2.0 * std::sqrt(0.1 / 20.0);
  double lost = 0.0, time = 0.0;
  for (size_t k = 0; k < timed.pieces.size(); ++k) {
    const SpeedRange range = tool_speed_range(timed.pieces[k].timing, timed.pieces[k].duration,
                                              with_tool.rates[timed.origin[k]].linear, 0.1);
    if (range.least < 0.1 * (1.0 - kHeldWithin)) lost += timed.pieces[k].duration;
    time += timed.pieces[k].duration;
  }
  EXPECT_LE(lost, 1.5 * 2.0 * ramp);
  EXPECT_LE(time, 1.005 * (0.5 / 0.1 + ramp));
}

}  // namespace
}  // namespace viapoint::testing
