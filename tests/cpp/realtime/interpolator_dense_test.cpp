// Motions that pass over hundreds of pieces in each cycle.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <vector>

#include "realtime/no_allocation_scope.hpp"
#include "realtime/random_motion.hpp"
#include "viapoint/realtime/interpolator.hpp"

namespace viapoint {
namespace {

constexpr std::chrono::nanoseconds kCycle{2'000'000};
constexpr double kSeconds = 2e-3;

/// Three thousand moves of 1e-8 rad whose pieces switch outputs.
Motion dense_motion_with_outputs(std::mt19937& random) {
  Motion motion = dense_motion(3000);
  std::vector<TrajectoryPiece> pieces = motion.trajectory.pieces();
  std::uniform_int_distribution<int> index(0, 63), count(0, 3);
  for (TrajectoryPiece& piece : pieces) {
    piece.outputs = count(random);
    for (int i = 0; i < piece.outputs; ++i) {
      piece.output[static_cast<std::size_t>(i)] = {static_cast<std::int16_t>(index(random)),
                                                   index(random) < 32};
    }
  }
  motion.trajectory = Trajectory(std::move(pieces), motion.limits);
  return motion;
}

/// The outputs at τ, piece by piece.
std::uint64_t outputs_at(const Trajectory& motion, double tau, std::uint64_t before) {
  std::uint64_t outputs = before;
  for (std::size_t p = 0; p < motion.pieces().size() && motion.start_of(p) <= tau; ++p) {
    const TrajectoryPiece& piece = motion.pieces()[p];
    for (int i = 0; i < piece.outputs; ++i) {
      const OutputChange& change = piece.output[static_cast<std::size_t>(i)];
      const std::uint64_t bit = std::uint64_t{1} << change.index;
      outputs = change.value ? outputs | bit : outputs & ~bit;
    }
  }
  return outputs;
}

TEST(DenseMotion, AMotionOfManyPiecesACycleKeepsItsBitsAndOutputs) {
  std::mt19937 random(17);
  const Motion first = dense_motion_with_outputs(random);
  const Motion second = dense_motion_with_outputs(random);
  Interpolator interpolator(first.limits, kCycle, JointVector::Zero(2));
  Setpoint setpoint;
  std::uint64_t before = 0;
  for (const Motion* motion : {&first, &second}) {
    const Trajectory& trajectory = motion->trajectory;
    ASSERT_TRUE(trajectory.certificate().holds());
    interpolator.begin(trajectory);
    for (std::uint64_t k = 0; interpolator.active(); ++k) {
      interpolator.tick(setpoint);
      const double t = std::min(static_cast<double>(k) * kSeconds, trajectory.duration());
      ASSERT_EQ(interpolator.nominal_time(), t);
      const JointState expected = trajectory.at(t);
      ASSERT_EQ(setpoint.q, expected.q);
      ASSERT_EQ(setpoint.qddd, expected.qddd);
      ASSERT_EQ(setpoint.outputs, outputs_at(trajectory, t, before)) << "cycle " << k;
    }
    before = setpoint.outputs;
    EXPECT_EQ(interpolator.move(), 2999);
  }
}

TEST(DenseMotion, LooksAtABoundedNumberOfPiecesACycle) {
  // A joint that takes 8 s to build up its acceleration: cells of 64 ms, 5000 pieces each.
  const Motion motion = dense_motion(20000);
  JointLimits slow = motion.limits;
  slow.velocity[1] = 1.0;
  slow.acceleration[1] = 8.0;
  slow.jerk[1] = 1.0;
  for (const JointLimits& limits : {motion.limits, slow}) {
    Interpolator interpolator(limits, kCycle, JointVector::Zero(2));
    Setpoint setpoint;
    const NoAllocationScope scope;
    interpolator.begin(motion.trajectory);
    int most = 0;
    while (interpolator.active()) {
      interpolator.tick(setpoint);
      most = std::max(most, interpolator.pieces_looked_at());
    }
    EXPECT_EQ(scope.calls(), 0U);
    EXPECT_EQ(most, Interpolator::kPiecesACycle);
  }
}

TEST(DenseMotion, PausesAMotionOfManyPiecesACycle) {
  const Motion motion = dense_motion(20000);
  Interpolator interpolator(motion.limits, kCycle, JointVector::Zero(2));
  interpolator.begin(motion.trajectory);
  Setpoint setpoint;
  for (int k = 0; k < 50; ++k) interpolator.tick(setpoint);
  interpolator.wish(Wish::kPause);
  int cycles = 0;
  while (interpolator.tick(setpoint) != RunState::kPaused) ASSERT_LT(++cycles, 100);
  interpolator.wish(Wish::kRun);
  while (interpolator.active()) interpolator.tick(setpoint);
  EXPECT_EQ(interpolator.state(), RunState::kFinished);
}

}  // namespace
}  // namespace viapoint
