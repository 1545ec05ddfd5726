// One joint more than the curve takes: a smoothed way of joints, and joints that follow it.
#include "viapoint/path/joint_guide.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "path/curve_follower.hpp"
#include "path/insertion_checks.hpp"
#include "path/random_curves.hpp"
#include "problem_count.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

constexpr size_t kPlaces = 25;

/// An arm of seven joints on a line, and joints on it that wander in what the line leaves open.
struct Problem7 {
  explicit Problem7(unsigned seed) : random(seed) {
    start = 0.6 * testing::random_joints(random, limits);
    const JointVector end = start + 0.2 * (testing::random_joints(random, limits) - start);
    curve.emplace(arm.pose(start), arm.pose(end));
    find_way();
  }

  void find_way() {
    const CurveFollower follower(arm, *curve, start, options);
    way = {start};
    std::uniform_real_distribution<double> uniform(-0.04, 0.04);
    for (size_t k = 1; k < kPlaces; ++k) {
      const double s = curve->length() * static_cast<double>(k) / (kPlaces - 1);
      JointVector open = follower.open_direction(way.back());
      if (k > 1 && open.dot(before) < 0.0) open = -open;
      before = open;
      const auto knot = follower.solve(s, way.back() + uniform(random) * open);
      // Without a jump, as it must be.
      if (!knot || (knot->point.q - way.back()).cwiseAbs().maxCoeff() > 0.2) return;
      way.push_back(knot->point.q);
    }
  }

  [[nodiscard]] bool complete() const { return way.size() == kPlaces; }
  [[nodiscard]] JointGuide guide(bool goal_counts) const {
    return smooth_guide(arm, limits, *curve, way, goal_counts, options);
  }

  std::mt19937 random;
  ForwardKinematics arm = testing::panda();
  JointLimits limits = testing::range_of(arm);
  InsertionOptions options;
  JointVector start, before;
  std::optional<LineCurve> curve;
  std::vector<JointVector> way;
};

double square_of(const std::vector<JointVector>& way) {
  double sum = 0.0;
  for (size_t k = 1; k < way.size(); ++k) sum += (way[k] - way[k - 1]).squaredNorm();
  return sum;
}

TEST(JointGuide, ShortensAWayOnItsCurve) {
  int smoothed = 0;
  for (unsigned seed = 0; seed < problems(150U); ++seed) {
    SCOPED_TRACE(seed);
    const Problem7 problem(seed);
    if (!problem.complete()) continue;
    const bool goal_counts = seed % 2 == 0;
    const JointGuide guide = problem.guide(goal_counts);
    const double length = problem.curve->length();
    ASSERT_NEAR(guide.joints.length(), length, 1e-12 * length);
    std::vector<JointVector> places;
    for (size_t k = 0; k < kPlaces; ++k) {
      const double s = length * static_cast<double>(k) / (kPlaces - 1);
      places.push_back(guide.joints.at(s).q);
      const Pose pose = problem.arm.pose(places.back());
      ASSERT_LT((pose.translation() - problem.curve->at(s).p).norm(), 1e-6);
      ASSERT_LT(rotation_distance(pose.linear(), problem.curve->at(s).rotation), 1e-6);
    }
    ASSERT_LT((places.front() - problem.start).norm(), 1e-9);
    if (goal_counts) {
      ASSERT_LT((places.back() - problem.way.back()).norm(), 1e-9);
    }
    // By a limit the way may have to be longer.
    if (!problem.limits.contains(0.85 * places.front() + 0.15 * problem.limits.position_max)) {
      continue;
    }
    smoothed += square_of(places) < square_of(problem.way) ? 1 : 0;
  }
  EXPECT_GT(smoothed, problems(75));
}

TEST(JointGuide, LeavesALimitThatTheWayTouches) {
  int left = 0;
  for (unsigned seed = 0; seed < problems(150U); ++seed) {
    SCOPED_TRACE(seed);
    Problem7 problem(seed);
    if (!problem.complete()) continue;
    // The limit of one joint goes where the way has its largest value.
    const auto joint = static_cast<Eigen::Index>(seed % 7);
    double most = -10.0;
    size_t where = 0;
    for (size_t k = 0; k < kPlaces; ++k) {
      if (problem.way[k][joint] > most) {
        most = problem.way[k][joint];
        where = k;
      }
    }
    if (where < kPlaces / 3) continue;  // the start is held, and it takes a while to get away
    problem.limits.position_max[joint] = most;
    const CurveFollower follower(problem.arm, *problem.curve, problem.start, problem.options);
    // A joint that the open direction does not move cannot leave.
    if (std::abs(follower.open_direction(problem.way[where])[joint]) < 0.2) continue;
    const JointGuide guide = problem.guide(false);
    for (int k = 0; k <= 200; ++k) {
      const double s = problem.curve->length() * k / 200.0;
      ASSERT_LT(guide.joints.at(s).q[joint], most + 1e-3);
    }
    ++left;
  }
  EXPECT_GT(left, problems(8));
}

// The joints that follow a guide are one curve: what is told as its derivatives are its own.
TEST(JointGuide, IsFollowedWithExactDerivatives) {
  int compared = 0;
  for (unsigned seed = 0; seed < problems(150U); ++seed) {
    SCOPED_TRACE(seed);
    Problem7 problem(seed);
    if (!problem.complete()) continue;
    const JointGuide guide = problem.guide(seed % 2 == 0);
    problem.options.guide = &guide;
    const CurveFollower follower(problem.arm, *problem.curve, problem.start, problem.options);
    const double length = problem.curve->length();
    const double s = 0.37 * length, h = 1e-4 * length;
    std::array<PathPoint, 5> around;
    bool all = true;
    for (size_t i = 0; i < around.size(); ++i) {
      const double at = s + (static_cast<double>(i) - 2.0) * h;
      const auto knot = follower.solve(at, guide.joints.at(at).q);
      all = all && knot.has_value();
      if (knot) around[i] = knot->point;
    }
    ASSERT_TRUE(all);
    const double asked = guide.direction.at(s).q.dot(around[2].q - guide.joints.at(s).q);
    ASSERT_LT(std::abs(asked), 1e-10);
    const auto change = [&](JointVector PathPoint::* value) -> JointVector {
      return (around[0].*value - 8.0 * around[1].*value + 8.0 * around[3].*value -
              around[4].*value) /
             (12.0 * h);
    };
    const double size = around[2].q2.norm() + around[2].q1.norm() / length;
    if (size * length > 50.0) continue;  // by a singularity all is wild
    ASSERT_LT((change(&PathPoint::q) - around[2].q1).norm(), 1e-5 * around[2].q1.norm());
    ASSERT_LT((change(&PathPoint::q1) - around[2].q2).norm(), 1e-4 * size);
    ++compared;
  }
  EXPECT_GT(compared, problems(75));
}

TEST(JointGuide, IsInsertedWithTheSameProof) {
  int inserted = 0;
  for (unsigned seed = 0; seed < problems(60U); ++seed) {
    SCOPED_TRACE(seed);
    Problem7 problem(seed);
    if (!problem.complete()) continue;
    // At a singular pose the open direction turns at once, and a guide of so few places cannot
    // tell.
    const CurveFollower follower(problem.arm, *problem.curve, problem.start, problem.options);
    if (follower.singular_values(problem.way.back())[5] < 0.005) continue;
    const JointGuide guide = problem.guide(true);
    problem.options.guide = &guide;
    try {
      const Insertion found =
          insert_curve(problem.arm, problem.limits, *problem.curve, problem.start, problem.options);
      ASSERT_LT((found.knots.back() - problem.way.back()).norm(), 1e-6);
      double s0 = 0.0;
      for (const JointPiece& piece : found.pieces) {
        for (int k = 0; k <= 50; ++k) {
          const double s = piece.length * k / 50.0;
          const Pose pose = problem.arm.pose(piece.at(s).q);
          const CurvePoint wanted = problem.curve->at(std::min(s0 + s, problem.curve->length()));
          ASSERT_LE((pose.translation() - wanted.p).norm(), piece.position_deviation + 1e-13);
          ASSERT_LE(rotation_distance(pose.linear(), wanted.rotation),
                    piece.angle_deviation + 1e-13);
        }
        s0 += piece.length;
      }
      ++inserted;
    } catch (const MotionError& error) {
      ASSERT_TRUE(error.problem().share.has_value()) << error.what();
    }
  }
  EXPECT_GT(inserted, problems(30));
}

TEST(JointGuide, RefusesAWayOfTwoPlaces) {
  Problem7 problem(1);
  problem.way.resize(2);
  EXPECT_THROW((void)problem.guide(false), MotionError);
}

}  // namespace
}  // namespace viapoint
