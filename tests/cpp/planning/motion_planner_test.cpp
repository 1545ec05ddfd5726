#include "viapoint/planning/motion_planner.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "planning/planner_fixture.hpp"

namespace viapoint {
namespace {

using namespace testing_planner;

constexpr Zone kRadius50{ZoneKind::kRadius, 0.05};

const Problem* find(const Report& report, ErrorCode code) {
  for (const Problem& problem : report.problems) {
    if (problem.code == code) return &problem;
  }
  return nullptr;
}

class PumaPlanner : public testing::Test {
 protected:
  RobotPtr puma_ = robot("puma560");
  MotionPlanner planner_{puma_};

  Script script(const JointVector& start) { return {*puma_, start}; }
  Pose pose(const JointVector& q) { return puma_->forward().pose(q); }

  void expect_sound(const PlannedMotion& motion, const JointVector& start, const JointVector& end) {
    const Certificate& certificate = motion.trajectory.certificate();
    EXPECT_TRUE(certificate.holds()) << certificate.problems.front().describe();
    for (int i = 0; i < puma_->joints(); ++i) {
      const auto k = static_cast<size_t>(i);
      EXPECT_LE(certificate.velocity[k].share, 1 + 1e-6);
      EXPECT_LE(certificate.acceleration[k].share, 1 + 1e-6);
      EXPECT_LE(certificate.jerk[k].share, 1 + 1e-6);
    }
    EXPECT_LT((motion.trajectory.at(0).q - start).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((motion.trajectory.at(motion.trajectory.duration()).q - end).cwiseAbs().maxCoeff(),
              1e-9);
  }
};

TEST_F(PumaPlanner, RunsTheTextbookJointMoveWithABlendAtB) {
  Script stop = script(puma_a());
  stop.movej(puma_b()).movej(puma_c());
  const PlannedMotion stopped = planner_.plan(stop.program());
  expect_sound(stopped, puma_a(), puma_c());

  Script blend = script(puma_a());
  blend.movej(puma_b(), {ZoneKind::kJointDeviation, 0.05}).movej(puma_c());
  const PlannedMotion blended = planner_.plan(blend.program());
  expect_sound(blended, puma_a(), puma_c());
  ASSERT_EQ(blended.corners.size(), 1U);
  EXPECT_FALSE(blended.corners[0].stopped) << blended.corners[0].reason;
  EXPECT_LE(blended.corners[0].used, 0.05);
  EXPECT_GT(blended.corners[0].used, 0.04);
  EXPECT_LT(blended.trajectory.duration(), stopped.trajectory.duration());
}

TEST_F(PumaPlanner, FindsThatTheStraightLegBCBreaksJoint4AndOffersWaysThatWork) {
  // Textbook §3: with the least rotation A->B arrives on the other wrist branch; from there joint 4
  // passes 140° at 74 % of B->C.
  Script program = script(puma_a());
  program.movel(pose(puma_b())).movel(pose(puma_c()));
  const Report report = planner_.check(program.program());
  const Problem* problem = find(report, ErrorCode::kJointLimit);
  ASSERT_NE(problem, nullptr) << report.describe();
  EXPECT_EQ(problem->joint, 3);
  EXPECT_EQ(problem->move, 1);
  EXPECT_EQ(problem->line, 2);
  EXPECT_EQ(problem->file, "cell.py");
  EXPECT_NEAR(problem->share.value_or(0.0), 0.74, 0.01);
  EXPECT_NEAR(problem->limit.value_or(0.0), 140 * kDegree, 1e-9);
  ASSERT_EQ(problem->ways_out.size(), 2U) << problem->describe();
  EXPECT_NE(problem->ways_out[0].find("movej"), std::string::npos);
  EXPECT_NE(problem->ways_out[1].find("wrist"), std::string::npos);
  EXPECT_THROW((void)planner_.plan(program.program()), MotionError);
}

TEST_F(PumaPlanner, RunsTheCartesianMoveWithTheWristInterpolatedAndReachesThePrintedJointsOfC) {
  Script program = script(puma_a());
  program.movel(pose(puma_b()), kRadius50).movel(pose(puma_c()), {}, Orientation::kWrist);
  const PlannedMotion motion = planner_.plan(program.program());
  expect_sound(motion, puma_a(), puma_c());
  const Certificate& certificate = motion.trajectory.certificate();
  EXPECT_LE(certificate.path_deviation, 5e-5);
  EXPECT_LE(certificate.angle_deviation, 0.0100001 * kDegree);
  EXPECT_GT(certificate.manipulability, 0.0);
  ASSERT_EQ(motion.corners.size(), 1U);
  EXPECT_FALSE(motion.corners[0].stopped) << motion.corners[0].reason;

  // The tool never leaves the two legs by more than the zone, seen by dense sampling.
  const Eigen::Vector3d a = pose(puma_a()).translation();
  const Eigen::Vector3d b = pose(puma_b()).translation();
  const Eigen::Vector3d c = pose(puma_c()).translation();
  const auto from_leg = [](const Eigen::Vector3d& p, const Eigen::Vector3d& u,
                           const Eigen::Vector3d& v) {
    const double t = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
    return (p - u - t * (v - u)).norm();
  };
  for (int k = 0; k <= 2000; ++k) {
    const double t = motion.trajectory.duration() * k / 2000.0;
    const Eigen::Vector3d p = pose(motion.trajectory.at(t).q).translation();
    const double distance = std::min(from_leg(p, a, b), from_leg(p, b, c));
    const double allowed = (p - b).norm() <= 0.05 ? 0.05 : 5e-5;
    ASSERT_LE(distance, allowed) << "t = " << t;
  }
}

TEST_F(PumaPlanner, ReportsEveryProblemOfAProgramAtOnce) {
  Script program = script(puma_a());
  JointVector outside = puma_b();
  outside[1] = 200 * kDegree;
  Pose far = pose(puma_b());
  far.translation().x() = 5.0;
  program.movej(outside);               // line 1
  program.movel(far);                   // line 2
  program.add(Wait{-1.0});              // line 3
  program.add(SetOutput{64, true});     // line 4
  program.movej(JointVector::Zero(5));  // line 5
  MoveOptions bad;
  bad.scale = 1.5;
  program.add(PtpMove{JointTarget{puma_c()}}, bad);  // line 6
  const Report report = planner_.check(program.program());
  ASSERT_EQ(report.problems.size(), 6U) << report.describe();
  const ErrorCode expected[] = {ErrorCode::kJointLimit,  ErrorCode::kUnreachable,
                                ErrorCode::kBadArgument, ErrorCode::kBadArgument,
                                ErrorCode::kBadArgument, ErrorCode::kBadArgument};
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(report.problems[i].code, expected[i]) << report.problems[i].describe();
    EXPECT_EQ(report.problems[i].line, static_cast<int>(i) + 1);
    EXPECT_EQ(report.problems[i].severity, Severity::kError);
  }
  EXPECT_EQ(report.problems[0].joint, 1);
}

TEST_F(PumaPlanner, RefusesEmptyProgramsAndStartsOutsideTheLimits) {
  EXPECT_NE(find(planner_.check(script(puma_a()).program()), ErrorCode::kEmptyProgram), nullptr);
  JointVector start = puma_a();
  start[0] = 3.0;
  Script program = script(start);
  program.movej(puma_b());
  EXPECT_NE(find(planner_.check(program.program()), ErrorCode::kJointLimit), nullptr);
  start[0] = std::nan("");
  EXPECT_FALSE(planner_.check(script(start).movej(puma_b()).program()).ok());
}

TEST_F(PumaPlanner, LeavesOutMovesThatGoNowhereAndSaysSo) {
  Script program = script(puma_a());
  program.movej(puma_a()).movej(puma_b()).movel(pose(puma_b()));
  const PlannedMotion motion = planner_.plan(program.program());
  EXPECT_EQ(motion.report.problems.size(), 2U) << motion.report.describe();
  for (const Problem& problem : motion.report.problems) {
    EXPECT_EQ(problem.code, ErrorCode::kZeroLength);
    EXPECT_EQ(problem.severity, Severity::kWarning);
  }
  expect_sound(motion, puma_a(), puma_b());
}

TEST_F(PumaPlanner, RefusesAHalfTurnByItsOwnName) {
  Script program = script(puma_a());
  Pose turned = pose(puma_a());
  turned.linear() *= Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  turned.translation().x() += 0.05;
  program.movel(turned);
  EXPECT_NE(find(planner_.check(program.program()), ErrorCode::kHalfTurn), nullptr);
}

TEST_F(PumaPlanner, ShrinksAZoneLargerThanItsLegsAndSaysSo) {
  Script program = script(puma_a());
  JointVector near = puma_a();
  near[0] += 0.05;
  JointVector next = near;
  next[1] -= 0.05;
  program.movej(near, {ZoneKind::kRadius, 1.0}).movej(next);
  const PlannedMotion motion = planner_.plan(program.program());
  const Problem* warning = find(motion.report, ErrorCode::kZoneShrunk);
  ASSERT_NE(warning, nullptr) << motion.report.describe();
  EXPECT_EQ(warning->move, 0);
  EXPECT_LT(motion.corners.at(0).used, 1.0);
  expect_sound(motion, puma_a(), next);
}

TEST_F(PumaPlanner, MakesANearReversalAStopAndSaysSo) {
  Script program = script(puma_a());
  program.movej(puma_b(), {ZoneKind::kJointDeviation, 0.05}).movej(puma_a());
  const PlannedMotion motion = planner_.plan(program.program());
  ASSERT_EQ(motion.corners.size(), 1U);
  EXPECT_TRUE(motion.corners[0].stopped);
  EXPECT_NE(find(motion.report, ErrorCode::kZoneIsStop), nullptr);
  expect_sound(motion, puma_a(), puma_a());
}

TEST_F(PumaPlanner, KeepsToolSpeedAndScale) {
  Pose down = pose(puma_a());
  down.translation().z() += 0.15;
  Script program = script(puma_a());
  MoveOptions slow;
  slow.speed = 0.1;
  slow.acceleration = 0.5;
  program.add(LinMove{PoseTarget{down}, Orientation::kLeast}, slow);
  MoveOptions tenth;
  tenth.scale = 0.1;
  program.add(PtpMove{JointTarget{puma_b()}}, tenth);
  const PlannedMotion motion = planner_.plan(program.program());
  double fastest = 0.0;
  for (const TrajectoryPiece& piece : motion.trajectory.pieces()) {
    for (int k = 0; k <= 20; ++k) {
      const JointState state = piece.at(piece.duration * k / 20.0);
      if (piece.move == 0) {
        const Jacobian jacobian = puma_->jacobian(state.q);
        fastest = std::max(fastest, (jacobian.topRows<3>() * state.qd).norm());
      } else {
        ASSERT_LE((state.qd.cwiseAbs().array() / puma_->limits().velocity.array()).maxCoeff(),
                  0.1 + 1e-9);
      }
    }
  }
  EXPECT_LE(fastest, 0.1 * (1 + 1e-9));
  EXPECT_GT(fastest, 0.099);
}

TEST_F(PumaPlanner, ChangesOutputsWhereTheyStand) {
  Script program = script(puma_a());
  program.add(SetOutput{1, true});
  program.movej(puma_b(), {ZoneKind::kJointDeviation, 0.05});
  program.add(SetOutput{2, true});
  program.movej(puma_c());
  program.add(Wait{0.1}).add(SetOutput{3, true});
  const PlannedMotion motion = planner_.plan(program.program());
  ASSERT_EQ(motion.corners.size(), 1U);
  EXPECT_FALSE(motion.corners[0].stopped);
  const auto& pieces = motion.trajectory.pieces();
  ASSERT_EQ(pieces.front().outputs, 1);
  EXPECT_EQ(pieces.front().output[0].index, 1);
  ASSERT_EQ(pieces.back().outputs, 1);
  EXPECT_EQ(pieces.back().output[0].index, 3);
  size_t second = 0;
  while (second < pieces.size() && (second == 0 || pieces[second].outputs == 0)) ++second;
  ASSERT_LT(second, pieces.size());
  EXPECT_EQ(pieces[second].output[0].index, 2);
  // In the middle of the corner: the joints are nearest to B there.
  const double distance = (pieces[second].at(0.0).q - puma_b()).norm();
  EXPECT_LT(distance, 0.06);
}

TEST_F(PumaPlanner, RefusesTheProgramOfAnotherRobot) {
  Script program = script(puma_a());
  program.movej(puma_b());
  JointLimits slower = puma_->limits();
  slower.velocity *= 0.5;
  const MotionPlanner other(puma_->with_limits(slower));
  EXPECT_NE(find(other.check(program.program()), ErrorCode::kBadProgram), nullptr);
}

TEST_F(PumaPlanner, RefusesATimedMoveAmongOthers) {
  Script program = script(puma_a());
  program.movej(puma_b());
  program.add(TimedMove{});
  EXPECT_FALSE(planner_.check(program.program()).ok());
}

TEST_F(PumaPlanner, RefusesMoreOutputsAtAPointThanAPieceCarries) {
  Script program = script(puma_a());
  for (int round = 0; round < 100; ++round) {
    for (int i = 0; i < kMaxOutputsAPiece; ++i) program.add(SetOutput{i, true});
    program.add(Wait{0.0});  // a stop, not a pause: no cycle passes in it
  }
  program.movej(puma_b());
  const Report report = planner_.check(program.program());
  const Problem* problem = find(report, ErrorCode::kBadArgument);
  ASSERT_NE(problem, nullptr) << report.describe();
  EXPECT_EQ(problem->line, kMaxOutputsAPiece + 2);
}

TEST_F(PumaPlanner, RefusesWishesTooSmallToMean) {
  for (const double tiny : {0.0, 1e-300, 1e-7, -1.0, std::nan("")}) {
    SCOPED_TRACE(tiny);
    MoveOptions options[3];
    options[0].speed = tiny;
    options[1].acceleration = tiny;
    options[2].scale = tiny;
    for (const MoveOptions& wish : options) {
      Script program = script(puma_a());
      program.add(LinMove{PoseTarget{pose(puma_b())}, Orientation::kLeast}, wish);
      const Report report = planner_.check(program.program());
      const Problem* problem = find(report, ErrorCode::kBadArgument);
      ASSERT_NE(problem, nullptr);
      EXPECT_EQ(problem->line, 1);
    }
  }
}

TEST_F(PumaPlanner, DoesNotLetAToolSpeedSlowJointMoves) {
  MoveOptions wish;
  wish.speed = 0.001;
  wish.zone = {ZoneKind::kRadius, 0.02};
  Script slow = script(puma_a());
  slow.add(PtpMove{JointTarget{puma_b()}}, wish).add(PtpMove{JointTarget{puma_c()}}, wish);
  Script free = script(puma_a());
  free.movej(puma_b(), wish.zone).movej(puma_c());
  const PlannedMotion a = planner_.plan(slow.program());
  const PlannedMotion b = planner_.plan(free.program());
  EXPECT_FALSE(a.corners.at(0).stopped) << a.corners[0].reason;
  EXPECT_DOUBLE_EQ(a.trajectory.duration(), b.trajectory.duration());
}

TEST_F(PumaPlanner, LeavesOutLinesThatGoNowhereAndRefusesWristTurnsOnTheSpot) {
  Script program = script(puma_a());
  program.add(LinMove{PositionTarget{pose(puma_a()).translation()}, Orientation::kLeast});
  program.add(LinMove{PoseTarget{pose(puma_a())}, Orientation::kFixed});
  program.movel(pose(puma_a()), {}, Orientation::kWrist).movej(puma_b());
  const PlannedMotion motion = planner_.plan(program.program());
  ASSERT_EQ(motion.report.problems.size(), 3U) << motion.report.describe();
  for (const Problem& problem : motion.report.problems) {
    EXPECT_EQ(problem.code, ErrorCode::kZeroLength);
    EXPECT_TRUE(problem.line.has_value());
  }

  Pose turned = pose(puma_a());
  turned.linear() *= Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Script turn = script(puma_a());
  turn.movel(turned, {}, Orientation::kWrist);
  const Report report = planner_.check(turn.program());
  EXPECT_NE(find(report, ErrorCode::kBadArgument), nullptr) << report.describe();
}

TEST_F(PumaPlanner, TurnsOnTheSpotWhateverTheToolSpeed) {
  // Speed is that of the tool point: it says nothing of a turn about it, nor of one with a travel
  // far below what can be measured.
  const auto duration = [&](double travel) {
    Pose turned = pose(puma_a());
    turned.linear() *= Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    turned.translation().z() += travel;
    MoveOptions slow;
    slow.speed = 0.01;
    Script program = script(puma_a());
    program.add(LinMove{PoseTarget{turned}, Orientation::kLeast}, slow);
    return planner_.plan(program.program()).trajectory.duration();
  };
  const double still = duration(0.0);
  EXPECT_LT(still, 1.0);
  for (const double travel : {1e-10, 1e-9, 1e-8})
    EXPECT_NEAR(duration(travel), still, 0.05 * still);
}

TEST_F(PumaPlanner, FindsThatWaitsOfNoLengthAreNoProgram) {
  Script program = script(puma_a());
  program.add(Wait{0.0}).add(Wait{1e-320});
  EXPECT_NE(find(planner_.check(program.program()), ErrorCode::kEmptyProgram), nullptr);
}

TEST_F(PumaPlanner, RefusesTolerancesBelowRounding) {
  Script program = script(puma_a());
  program.movej(puma_b());
  program.program().tolerance.position = 1e-15;
  EXPECT_NE(find(planner_.check(program.program()), ErrorCode::kBadArgument), nullptr);
}

TEST(JointRobotPlanner, MovesJointsAndRefusesLines) {
  JointLimits limits;
  limits.position_min = JointVector::Constant(2, -INFINITY);
  limits.position_max = JointVector::Constant(2, INFINITY);
  limits.velocity = JointVector::Constant(2, 1.0);
  limits.acceleration = JointVector::Constant(2, 5.0);
  limits.jerk = JointVector::Constant(2, 50.0);
  const RobotPtr arm = RobotModel::joint_robot(limits);
  const MotionPlanner planner(arm);
  Script good(*arm, JointVector::Zero(2));
  good.movej(JointVector::Constant(2, 1.0), {ZoneKind::kJointDeviation, 0.01})
      .movej((JointVector(2) << 2.0, 0.0).finished());
  const PlannedMotion motion = planner.plan(good.program());
  EXPECT_TRUE(motion.trajectory.certificate().holds());
  EXPECT_FALSE(motion.corners.at(0).stopped) << motion.corners.at(0).reason;

  Script line(*arm, JointVector::Zero(2));
  line.movel(Pose::Identity());
  EXPECT_NE(find(planner.check(line.program()), ErrorCode::kUncontrolled), nullptr);
  Script zone(*arm, JointVector::Zero(2));
  zone.movej(JointVector::Constant(2, 1.0), kRadius50).movej(JointVector::Zero(2));
  EXPECT_NE(find(planner.check(zone.program()), ErrorCode::kBadArgument), nullptr);
}

}  // namespace
}  // namespace viapoint
