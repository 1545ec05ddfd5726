#include "viapoint/realtime/guard.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "problem_count.hpp"
#include "realtime/no_allocation_scope.hpp"
#include "realtime/random_motion.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {
namespace {

using Kind = Breach::Kind;
using Verdict = Guard::Verdict;

constexpr std::chrono::nanoseconds kCycle{2'000'000};
constexpr double kSeconds = 2e-3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A motion under its guard, with commands at random.
class Watched {
 public:
  explicit Watched(unsigned seed) : random_(seed), motion(random_motion(random_)) {
    const JointVector start = motion.trajectory.at(0.0).q;
    interpolator = std::make_unique<Interpolator>(motion.limits, kCycle, start);
    guard = std::make_unique<Guard>(motion.limits, kCycle, GuardOptions{}, start);
    interpolator->begin(motion.trajectory);
  }

  [[nodiscard]] double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  void command() {
    const double what = unit();
    if (what > 0.06) return;
    if (what < 0.02) return interpolator->set_override(unit());
    constexpr std::array kWishes = {Wish::kRun, Wish::kRun, Wish::kPause, Wish::kStep,
                                    Wish::kBackward};
    interpolator->wish(kWishes[static_cast<std::size_t>(unit() * 4.999)]);
  }
  /// The next setpoint, before the guard has seen it.
  const Setpoint& next() {
    command();
    interpolator->tick(setpoint);
    return setpoint;
  }

 private:
  std::mt19937 random_;

 public:
  Motion motion;
  std::unique_ptr<Interpolator> interpolator;
  std::unique_ptr<Guard> guard;
  Setpoint setpoint;
};

TEST(Guard, PassesEveryMotionWithEveryCommandUnchanged) {
  std::uint64_t cycles = 0, allocations = 0;
  for (unsigned seed = 0; seed < problems(400U); ++seed) {
    SCOPED_TRACE(seed);
    Watched run(seed);
    JointVector away = JointVector::Constant(run.motion.limits.joints(), 0.05);
    for (int k = 0; k < 700; ++k) {
      run.next();
      if (run.interpolator->state() == RunState::kPaused) run.interpolator->jog(away *= -1.0);
      const JointVector q = run.setpoint.q;
      const NoAllocationScope scope;
      const Verdict verdict = run.guard->pass(run.setpoint);
      allocations += scope.calls();
      ASSERT_EQ(verdict, Verdict::kPass) << text_of(run.guard->breach()) << ", cycle " << k;
      ASSERT_EQ(run.setpoint.q, q);
      ++cycles;
    }
  }
  EXPECT_GT(cycles, 20'000U);
  EXPECT_EQ(allocations, 0U);
}

/// What may be planted in a setpoint, and what the guard has to call it.
struct Fault {
  const char* name;
  void (*plant)(Setpoint& setpoint, const JointLimits& limits, double size);
  std::vector<Kind> kinds;
};

const std::vector<Fault> kFaults = {
    {"a position that is no number",
     [](Setpoint& s, const JointLimits&, double) { s.q[0] = kNan; },
     {Kind::kNotFinite}},
    {"an infinite velocity",
     [](Setpoint& s, const JointLimits&, double) { s.qd[0] = -kInfinity; },
     {Kind::kNotFinite}},
    {"a jerk that is no number",
     [](Setpoint& s, const JointLimits&, double) { s.qddd[0] = kNan; },
     {Kind::kNotFinite}},
    {"a joint too few",
     [](Setpoint& s, const JointLimits&, double) { s.q.conservativeResize(s.q.size() - 1); },
     {Kind::kNotFinite}},
    {"a jump",
     [](Setpoint& s, const JointLimits& l, double size) {
       s.q[0] += std::copysign(2.5 * kSeconds * l.velocity[0] + 1e-5, size);
     },
     {Kind::kVelocity}},
    {"a small jump",
     [](Setpoint& s, const JointLimits& l, double size) {
       s.q[0] += std::copysign(std::pow(kSeconds, 3) * l.jerk[0] + 5e-6, size);
     },
     {Kind::kDerivatives, Kind::kVelocity}},
    {"a velocity",
     [](Setpoint& s, const JointLimits& l, double size) {
       s.qd[0] = std::copysign(1.01 * l.velocity[0], size);
     },
     {Kind::kVelocity}},
    {"a step of the velocity",
     [](Setpoint& s, const JointLimits& l, double) {
       s.qd[0] -=
           std::copysign(std::min(2.1 * kSeconds * l.acceleration[0], l.velocity[0]), s.qd[0]);
     },
     {Kind::kAcceleration, Kind::kDerivatives, Kind::kVelocity}},
    {"an acceleration",
     [](Setpoint& s, const JointLimits& l, double size) {
       s.qdd[0] = std::copysign(1.01 * l.acceleration[0], size);
     },
     {Kind::kAcceleration}},
    {"a jerk",
     [](Setpoint& s, const JointLimits& l, double size) {
       s.qddd[0] = std::copysign(1.01 * l.jerk[0], size);
     },
     {Kind::kJerk}},
};

TEST(Guard, StopsEveryJointWithinItsLimitsWhateverIsToldIt) {
  int planted = 0;
  for (unsigned seed = 0; seed < problems(500U); ++seed) {
    const Fault& fault = kFaults[seed % kFaults.size()];
    SCOPED_TRACE(testing::Message() << fault.name << ", seed " << seed);
    Watched run(seed);
    const JointLimits& limits = run.motion.limits;
    std::vector<Setpoint> told;
    const int when = static_cast<int>(run.unit() * 300.0);
    for (int k = 0; k < when; ++k) {
      run.next();
      ASSERT_EQ(run.guard->pass(run.setpoint), Verdict::kPass);
      told.push_back(run.setpoint);
    }
    run.next();
    fault.plant(run.setpoint, limits, run.unit() - 0.5);
    Verdict verdict = run.guard->pass(run.setpoint);
    told.push_back(run.setpoint);
    const Breach breach = run.guard->breach();
    ASSERT_TRUE(std::ranges::count(fault.kinds, breach.kind) == 1) << text_of(breach);
    ASSERT_FALSE(breach.path_is_held());
    ASSERT_NE(text_of(breach), "");
    ++planted;
    for (int k = 0; verdict == Verdict::kOffPath; ++k) {
      ASSERT_LT(k, 20'000);
      run.setpoint.q.setConstant(limits.joints(), kNan);  // whatever comes now is not looked at
      verdict = run.guard->pass(run.setpoint);
      told.push_back(run.setpoint);
    }
    ASSERT_EQ(verdict, Verdict::kAtRest);
    ASSERT_TRUE(told.back().qd.isZero(0.0));
    for (std::size_t k = 1; k < told.size(); ++k) {
      for (int i = 0; i < limits.joints(); ++i) {
        ASSERT_TRUE(std::isfinite(told[k].q[i]));
        ASSERT_LE(std::abs(told[k].q[i] - told[k - 1].q[i]),
                  kSeconds * limits.velocity[i] * (1.0 + 1e-6));
        ASSERT_LE(std::abs(told[k].qd[i] - told[k - 1].qd[i]),
                  kSeconds * limits.acceleration[i] * (1.0 + 1e-6));
        ASSERT_LE(std::abs(told[k].qdd[i] - told[k - 1].qdd[i]),
                  kSeconds * limits.jerk[i] * (1.0 + 1e-6));
      }
    }
  }
  EXPECT_EQ(planted, static_cast<int>(problems(500U)));
}

/// One joint that turns a tool of 1 m about z.
ForwardKinematics lever() {
  ChainJoint joint;
  Pose tool = Pose::Identity();
  tool.translation() << 1.0, 0.0, 0.0;
  return ForwardKinematics(std::array{joint}, tool);
}

/// The lever's motion from 0 to 2 rad, at 2 rad/s where it is fastest.
Motion lever_motion() {
  Motion motion;
  motion.limits = even_limits(1, 2.0, 20.0, 200.0);
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, JointVector::Zero(1), JointVector::Constant(1, 2.0), motion.limits, 0);
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  return motion;
}

Breach breach_of(const Motion& motion, const GuardOptions& options) {
  Guard guard(motion.limits, kCycle, options, JointVector::Zero(1));
  Interpolator interpolator(motion.limits, kCycle, JointVector::Zero(1));
  interpolator.begin(motion.trajectory);
  Setpoint setpoint;
  while (interpolator.active()) {
    interpolator.tick(setpoint);
    const NoAllocationScope scope;
    const Verdict verdict = guard.pass(setpoint);
    EXPECT_EQ(scope.calls(), 0U);
    if (verdict == Verdict::kStopOnPath) interpolator.wish(Wish::kStop);
    EXPECT_TRUE(verdict == Verdict::kPass || verdict == Verdict::kStopOnPath);
  }
  if (guard.breach().any()) {
    EXPECT_EQ(interpolator.state(), RunState::kStopped) << "the arm has to stop on its path";
  }
  return guard.breach();
}

TEST(Guard, HoldsTheToolToItsSpeedAndBoxOnThePath) {
  const Motion motion = lever_motion();
  GuardOptions options;
  options.kinematics = lever();
  options.tool_speed = 2.001;
  EXPECT_FALSE(breach_of(motion, options).any());
  options.tool_speed = 0.25;
  const Breach speed = breach_of(motion, options);
  EXPECT_EQ(speed.kind, Kind::kToolSpeed);
  EXPECT_GT(speed.value, 0.25);
  EXPECT_LT(speed.value, 0.25 + 20.0 * kSeconds + 1e-9);
  options.tool_speed = GuardOptions::kNone;
  options.box_max.y() = 0.5;
  const Breach box = breach_of(motion, options);
  EXPECT_EQ(box.kind, Kind::kBox);
  EXPECT_EQ(box.index, 1);
  EXPECT_NEAR(box.value, 0.5, 2.0 * kSeconds);
  options.box_max.y() = 1.1;
  options.box_min.x() = -0.5;
  EXPECT_FALSE(breach_of(motion, options).any());
}

TEST(Guard, HoldsPositionLimitsButLetsAJointComeIn) {
  JointLimits limits = even_limits(1, 2.0, 20.0, 200.0);
  limits.position_max[0] = 1.0;
  Guard outside(limits, kCycle, {}, JointVector::Constant(1, 1.2));
  Setpoint setpoint;
  for (JointVector* vector : {&setpoint.qd, &setpoint.qdd, &setpoint.qddd}) vector->setZero(1);
  setpoint.q = JointVector::Constant(1, 1.2 - 1e-7);
  EXPECT_EQ(outside.pass(setpoint), Verdict::kPass);
  setpoint.q = JointVector::Constant(1, 1.2);
  EXPECT_EQ(outside.pass(setpoint), Verdict::kAtRest);
  EXPECT_EQ(outside.breach().kind, Kind::kPosition);
  EXPECT_EQ(setpoint.q[0], 1.2 - 1e-7) << "it stays where it rests";
}

TEST(Guard, HoldsCoupledLimitsButLetsTheJointsComeIn) {
  JointLimits limits = even_limits(2, 2.0, 20.0, 200.0);
  limits.coupling = CouplingMatrix::Ones(1, 2);
  limits.coupling_lower = CouplingVector::Constant(1, -1.0);
  limits.coupling_upper = CouplingVector::Constant(1, 1.0);
  Setpoint setpoint;
  for (JointVector* vector : {&setpoint.qd, &setpoint.qdd, &setpoint.qddd}) vector->setZero(2);
  const auto told = [&](Guard& guard, double q0, double q1) {
    setpoint.q = JointVector::Constant(2, q0);
    setpoint.q[1] = q1;
    return guard.pass(setpoint);
  };
  constexpr double kBeyond = 0.50001;  // each
  Guard at_limit(limits, kCycle, {}, JointVector::Constant(2, kBeyond));
  EXPECT_EQ(told(at_limit, kBeyond + 1e-6, kBeyond - 1e-6), Verdict::kPass) << "along the limit";
  EXPECT_EQ(told(at_limit, kBeyond + 2e-6, kBeyond - 2e-6), Verdict::kPass);
  EXPECT_EQ(told(at_limit, kBeyond + 2e-6, kBeyond - 1e-6), Verdict::kAtRest);
  EXPECT_EQ(at_limit.breach().kind, Kind::kCoupling);
  EXPECT_EQ(at_limit.breach().index, 0);
  EXPECT_NE(text_of(at_limit.breach()).find("coupled limit 1"), std::string::npos);
  Guard outside(limits, kCycle, {}, JointVector::Constant(2, -0.6));
  EXPECT_EQ(told(outside, -0.6 + 1e-7, -0.6), Verdict::kPass);
  EXPECT_EQ(told(outside, -0.6, -0.6), Verdict::kAtRest);
  EXPECT_EQ(outside.breach().kind, Kind::kCoupling);
}

TEST(Guard, LetsAnArmMoveOnWhileTheLoopSleepsThroughCycles) {
  const JointLimits limits = even_limits(1, 2.0, 20.0, 200.0);
  const auto breach_after = [&](std::int64_t late_cycles, int silent, double step) {
    Guard guard(limits, kCycle, {}, JointVector::Zero(1));
    for (int k = 0; k < silent; ++k) {
      guard.look_at(DriveStatus::kSilent, {JointVector::Zero(1), 0}, late_cycles);
    }
    guard.look_at(DriveStatus::kOk, {JointVector::Constant(1, step), 0}, late_cycles);
    return guard.breach().kind;
  };
  const double at_limit = 2.0 * kSeconds;  // in a cycle
  EXPECT_EQ(breach_after(0, 0, 10.0 * at_limit), Kind::kEncoder);
  EXPECT_EQ(breach_after(9, 0, 10.0 * at_limit), Kind::kNone);
  EXPECT_EQ(breach_after(4, 1, 10.0 * at_limit), Kind::kNone);
  EXPECT_EQ(breach_after(9, 0, 25.0 * at_limit), Kind::kEncoder);
}

TEST(Guard, SeesADriveThatIsSilentJumpsLagsOrLosesItsPower) {
  const JointLimits limits = even_limits(2, 2.0, 20.0, 200.0);
  const JointVector start = JointVector::Zero(2);
  const auto found = [&](const auto& answer) {
    Guard guard(limits, kCycle, {}, start);
    answer(guard);
    return guard.breach();
  };
  const Measurement here{start, 0};
  EXPECT_FALSE(found([&](Guard& guard) {
                 for (int k = 0; k < 100; ++k) {
                   guard.look_at(k % 11 == 0 ? DriveStatus::kOk : DriveStatus::kSilent, here);
                 }
               }).any());
  const Breach silent = found([&](Guard& guard) {
    for (int k = 0; k < 11; ++k) guard.look_at(DriveStatus::kSilent, here);
  });
  EXPECT_EQ(silent.kind, Kind::kSilent);
  EXPECT_TRUE(silent.path_is_held());
  const Breach jump = found([&](Guard& guard) {
    Measurement there = here;
    guard.look_at(DriveStatus::kOk, here);
    there.q[1] = 0.05;
    guard.look_at(DriveStatus::kOk, there);
    guard.look_at(DriveStatus::kPowerLost, there);  // the first breach is the one that is told
  });
  EXPECT_EQ(jump.kind, Kind::kEncoder);
  EXPECT_EQ(jump.index, 1);
  const Breach no_number = found(
      [&](Guard& guard) { guard.look_at(DriveStatus::kOk, {JointVector::Constant(2, kNan), 0}); });
  EXPECT_EQ(no_number.kind, Kind::kEncoder);
  const Breach lag = found([&](Guard& guard) {
    Measurement away = here;
    for (int k = 0; k < 300; ++k) {
      away.q[0] -= 0.002;
      guard.look_at(DriveStatus::kOk, away);
    }
  });
  EXPECT_EQ(lag.kind, Kind::kFollowing);
  EXPECT_EQ(found([&](Guard& g) { g.look_at(DriveStatus::kPowerLost, here); }).kind,
            Kind::kPowerLost);
}

}  // namespace
}  // namespace viapoint
