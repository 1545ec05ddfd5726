/// The laws of motions alone: what the certificate says must be so, and limits are kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "motion_subjects.hpp"

namespace viapoint::laws {
namespace {

constexpr int kSamples = 20000;

class MotionLaws : public ::testing::TestWithParam<Subject<MotionCase>> {};

TEST_P(MotionLaws, PiecesTileTheTime) {
  const Trajectory trajectory = GetParam().make().trajectory;
  double sum = 0.0;
  for (size_t i = 0; i < trajectory.pieces().size(); ++i) {
    EXPECT_EQ(trajectory.start_of(i), sum);
    // A knot belongs to the later piece.
    EXPECT_EQ(trajectory.piece_at(sum), i);
    sum += trajectory.pieces()[i].duration;
  }
  EXPECT_EQ(trajectory.duration(), sum);
}

TEST_P(MotionLaws, HoldsStillOutsideItsTime) {
  const Trajectory trajectory = GetParam().make().trajectory;
  EXPECT_EQ(trajectory.at(-1.0).q, trajectory.at(0.0).q);
  EXPECT_EQ(trajectory.at(trajectory.duration() + 1.0).q, trajectory.at(trajectory.duration()).q);
}

TEST_P(MotionLaws, NeverExceedsItsCertificate) {
  const MotionCase subject = GetParam().make();
  const Certificate& proven = subject.trajectory.certificate();
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> time(0.0, subject.trajectory.duration());
  for (int i = 0; i < kSamples; ++i) {
    const double t = time(random);
    const JointState state = subject.trajectory.at(t);
    for (int joint = 0; joint < subject.trajectory.joints(); ++joint) {
      const auto j = static_cast<size_t>(joint);
      // The samples are rounded too, by 1e-9 of the limit at most.
      ASSERT_LE(std::abs(state.qd[joint]),
                proven.velocity[j].value + 1e-9 * subject.limits.velocity[joint])
          << t;
      ASSERT_LE(std::abs(state.qdd[joint]),
                proven.acceleration[j].value + 1e-9 * subject.limits.acceleration[joint])
          << t;
      ASSERT_LE(std::abs(state.qddd[joint]),
                proven.jerk[j].value + 1e-9 * subject.limits.jerk[joint])
          << t;
      ASSERT_GE(state.q[joint], proven.position_min[joint] - 1e-12) << t;
      ASSERT_LE(state.q[joint], proven.position_max[joint] + 1e-12) << t;
    }
  }
}

TEST_P(MotionLaws, ReachesWhatItsCertificateSaysWhereItSays) {
  const MotionCase subject = GetParam().make();
  const Certificate& proven = subject.trajectory.certificate();
  const double nudge = 4 * std::numeric_limits<double>::epsilon() * subject.trajectory.duration();
  const auto expect_reached = [&](const std::vector<Extremum>& extrema, auto derivative,
                                  const JointVector& limit) {
    for (int joint = 0; joint < subject.trajectory.joints(); ++joint) {
      const Extremum& worst = extrema[static_cast<size_t>(joint)];
      // On either side: at a knot the earlier piece may be the one.
      const double reached =
          std::max(std::abs((subject.trajectory.at(worst.time).*derivative)[joint]),
                   std::abs((subject.trajectory.at(worst.time - nudge).*derivative)[joint]));
      EXPECT_NEAR(reached, worst.value, 1e-6 * limit[joint]) << "joint " << joint + 1;
      EXPECT_NEAR(worst.share, worst.value / limit[joint], 1e-12);
      const int move = worst.move;
      const auto& pieces = subject.trajectory.pieces();
      EXPECT_TRUE(pieces[subject.trajectory.piece_at(worst.time)].move == move ||
                  pieces[subject.trajectory.piece_at(worst.time - nudge)].move == move);
    }
  };
  expect_reached(proven.velocity, &JointState::qd, subject.limits.velocity);
  expect_reached(proven.acceleration, &JointState::qdd, subject.limits.acceleration);
  expect_reached(proven.jerk, &JointState::qddd, subject.limits.jerk);
}

INSTANTIATE_TEST_SUITE_P(Motions, MotionLaws, ::testing::ValuesIn(all_motions()), SubjectName());

class SoundMotionLaws : public ::testing::TestWithParam<Subject<MotionCase>> {};

TEST_P(SoundMotionLaws, CertificateHoldsWithEveryShareKept) {
  const MotionCase subject = GetParam().make();
  const Certificate& proven = subject.trajectory.certificate();
  EXPECT_TRUE(proven.holds()) << proven.problems.front().describe();
  for (const auto* extrema : {&proven.velocity, &proven.acceleration, &proven.jerk}) {
    for (const Extremum& worst : *extrema) EXPECT_LE(worst.share, 1.0 + kLimitSlack);
  }
}

TEST_P(SoundMotionLaws, KeepsEveryLimitBetweenSamples) {
  const MotionCase subject = GetParam().make();
  std::mt19937_64 random(10);
  std::uniform_real_distribution<double> time(0.0, subject.trajectory.duration());
  for (int i = 0; i < kSamples; ++i) {
    const double t = time(random);
    const JointState state = subject.trajectory.at(t);
    ASSERT_TRUE(subject.limits.contains(state.q, 1e-9)) << t;
    for (int joint = 0; joint < subject.trajectory.joints(); ++joint) {
      ASSERT_LE(std::abs(state.qd[joint]), subject.limits.velocity[joint] * (1 + kLimitSlack));
      ASSERT_LE(std::abs(state.qdd[joint]), subject.limits.acceleration[joint] * (1 + kLimitSlack));
      ASSERT_LE(std::abs(state.qddd[joint]), subject.limits.jerk[joint] * (1 + kLimitSlack));
    }
  }
}

TEST_P(SoundMotionLaws, IsAtRestAtBothEnds) {
  const MotionCase subject = GetParam().make();
  for (const double t : {0.0, subject.trajectory.duration()}) {
    const JointState state = subject.trajectory.at(t);
    for (int joint = 0; joint < subject.trajectory.joints(); ++joint) {
      EXPECT_LE(std::abs(state.qd[joint]), 1e-9 * subject.limits.velocity[joint]) << t;
      EXPECT_LE(std::abs(state.qdd[joint]), 1e-9 * subject.limits.acceleration[joint]) << t;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Motions, SoundMotionLaws, ::testing::ValuesIn(sound_motions()),
                         SubjectName());

class StudyMotionLaws : public ::testing::TestWithParam<Subject<MotionCase>> {};

TEST_P(StudyMotionLaws, CertificateSaysThatItIsNotAtRest) {
  const MotionCase subject = GetParam().make();
  const auto& problems = subject.trajectory.certificate().problems;
  EXPECT_NE(std::ranges::find(problems, ErrorCode::kNotAtRest, &Problem::code), problems.end());
}

INSTANTIATE_TEST_SUITE_P(Motions, StudyMotionLaws, ::testing::ValuesIn(study_motions()),
                         SubjectName());

}  // namespace
}  // namespace viapoint::laws
