// Arcs, helices and splines as joints: nothing that was proven is broken, on any arm.
#include <gtest/gtest.h>

#include <memory>

#include "path/insertion_checks.hpp"
#include "path/random_curves.hpp"

namespace viapoint {
namespace {

using testing::expect_sound;
using testing::joints_in_degrees;
using testing::problem_of;

struct Sweep {
  const char* name;
  ForwardKinematics (*arm)();
  Hold hold;
  unsigned curves;
};

class CurveSweep : public ::testing::TestWithParam<Sweep> {};

TEST_P(CurveSweep, StaysWithinItsProofOrNamesTheProblem) {
  const ForwardKinematics arm = GetParam().arm();
  const JointLimits range = testing::range_of(arm);
  InsertionOptions options;
  options.hold = GetParam().hold;
  unsigned inserted = 0;
  for (unsigned seed = 0; seed < GetParam().curves; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const JointVector start = 0.6 * testing::random_joints(random, range);
    const auto curve = testing::random_curve(arm, random, start, options.hold);
    // Every tenth curve on 1000 places of every piece, the others on fewer; some tolerances tight.
    options.position_tolerance = seed % 7 == 0 ? 1e-7 : 5e-5;
    try {
      const Insertion found = insert_curve(arm, range, *curve, start, options);
      ASSERT_NO_FATAL_FAILURE(
          expect_sound(arm, range, *curve, found, options, seed % 10 == 0 ? 1000 : 30));
      ++inserted;
    } catch (const MotionError& error) {
      const ErrorCode code = error.code();
      ASSERT_TRUE(code == ErrorCode::kJointLimit || code == ErrorCode::kUnreachable ||
                  code == ErrorCode::kSingular || code == ErrorCode::kUncontrolled)
          << error.what();
      ASSERT_TRUE(error.problem().share.has_value());
      ASSERT_FALSE(error.problem().ways_out.empty());
    }
  }
  EXPECT_GT(inserted, GetParam().curves / 3);
}

INSTANTIATE_TEST_SUITE_P(
    Arms, CurveSweep,
    ::testing::Values(Sweep{"puma560", testing::puma560, Hold::kPose, 500},
                      Sweep{"ur5e", testing::ur5e, Hold::kPose, 300},
                      Sweep{"panda", testing::panda, Hold::kPose, 120},
                      Sweep{"puma560_axis", testing::puma560, Hold::kAxis, 300},
                      Sweep{"ur5e_axis", testing::ur5e, Hold::kAxis, 200},
                      Sweep{"panda_axis", testing::panda, Hold::kAxis, 60},
                      Sweep{"torch_axis", testing::torch, Hold::kAxis, 200},
                      Sweep{"five_axis", testing::five_joints, Hold::kAxis, 300},
                      Sweep{"scara", testing::scara, Hold::kPose, 400},
                      Sweep{"rpp", testing::rpp, Hold::kPosition, 500}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(InsertCurve, SeesAnErrorThatVanishesInTheMiddle) {
  // An S about the straight joint line: at its middle, and at its quarters, nothing is wrong.
  const ForwardKinematics arm = testing::rpp();
  JointVector start(3);
  start << 0.0, 0.1, 0.4;
  const Pose from = arm.pose(start);
  std::vector<JointVector> points;
  std::vector<double> at;
  for (int k = 0; k <= 16; ++k) {
    const double s = 0.2 * k / 16;
    // Zero at all multiples of an eighth, and not between.
    const double aside = k % 2 == 0 ? 0.0 : (k % 4 == 1 ? 2e-3 : -2e-3);
    points.emplace_back(from.translation() + Eigen::Vector3d(0.0, aside, s));
    at.push_back(s);
  }
  const ToolCurve curve(
      std::make_unique<SplineCurve>(quintic_chain(natural_spline(points, at, 3), at)),
      std::make_unique<SteadyTurn>(from.linear(), Eigen::Vector3d::Zero()));
  const JointLimits limits = testing::no_position_limits(3);
  InsertionOptions options;
  options.hold = Hold::kPosition;
  const Insertion found = insert_curve(arm, limits, curve, start, options);
  ASSERT_NO_FATAL_FAILURE(expect_sound(arm, limits, curve, found, options, 1000));
  EXPECT_GT(found.pieces.size(), 8u);
  // Taylor's test is blind to it: the midpoint of the joints is on the curve.
  const TaylorKnots blind = taylor_insertion(arm, curve, start, found.knots.back(), 1e-4, kPi);
  EXPECT_EQ(blind.knots.size(), 2u);
}

TEST(InsertCurve, FindsTheUnreachableMiddleOfAnArc) {
  // Both ends are within reach, the arc between them swings out of it.
  const ForwardKinematics arm = testing::puma560();
  const JointVector start = joints_in_degrees({10, 40, 20, 30, 40, 10});
  const Pose from = arm.pose(start);
  const double radius = from.translation().norm();
  const Eigen::Vector3d out = from.translation().normalized();
  const Eigen::Vector3d across = out.cross(Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d via = from.translation() + out * (1.2 - radius) + 0.2 * across;
  const Eigen::Vector3d end = from.translation() + 0.4 * across;
  auto arc = std::make_unique<HelixCurve>(HelixCurve::through(from.translation(), via, end));
  const HelixCurve shape = *arc;
  const ToolCurve curve(std::move(arc),
                        std::make_unique<SteadyTurn>(from.linear(), Eigen::Vector3d::Zero()));
  const auto problem = problem_of(arm, testing::no_position_limits(6), curve, start);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->code, ErrorCode::kUnreachable) << problem->message;
  // At that share the wrist is just at the end of the stretched arm.
  const double elbow = std::hypot(0.433, 0.02);
  const double reach = std::hypot(0.432 + elbow, 0.149);
  EXPECT_NEAR(shape.at(*problem->share * shape.length()).p.norm(), reach, 1e-4);
}

TEST(InsertCurve, FindsTheSingularityOnAnArc) {
  // The tool turns on the spot about an axis that a straight wrist cannot serve.
  const ForwardKinematics arm = testing::puma560();
  const JointVector at = joints_in_degrees({10, 40, 20, 0, 0, 0});
  const Pose from = arm.pose(at);
  const Eigen::Vector3d across = arm.frames(at).axis[4].cross(arm.frames(at).axis[3]);
  const auto curve = testing::helix(from, from.translation(), across, 0.3, 0.0, true);
  const auto problem = problem_of(arm, testing::no_position_limits(6), *curve, at);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->code, ErrorCode::kSingular);
}

/// The same curve, that does not tell its knots.
class SilentCurve final : public TaskCurve {
 public:
  explicit SilentCurve(const TaskCurve& curve) : curve_(curve) {}
  [[nodiscard]] double length() const override { return curve_.length(); }
  [[nodiscard]] CurvePoint at(double s) const override { return curve_.at(s); }
  [[nodiscard]] CurveBounds bounds(double s0, double s1) const override {
    return curve_.bounds(s0, s1);
  }

 private:
  const TaskCurve& curve_;
};

TEST(InsertCurve, NeedsFewerPiecesWhereTheyEndAtTheCurvesKnots) {
  const ForwardKinematics arm = testing::puma560();
  std::mt19937 random(8);
  const JointVector start = joints_in_degrees({0, 25, 0, 15, 50, 10});
  const auto poses = testing::poses_on_a_walk(arm, random, start, 5, 0.2);
  const auto curve = testing::spline_through(poses, 3, true);
  const JointLimits limits = testing::no_position_limits(6);
  InsertionOptions options;
  options.position_tolerance = 1e-6;
  options.angle_tolerance = 1e-5;
  const size_t telling = insert_curve(arm, limits, *curve, start, options).pieces.size();
  const size_t silent =
      insert_curve(arm, limits, SilentCurve(*curve), start, options).pieces.size();
  EXPECT_LT(telling, silent);
}

}  // namespace
}  // namespace viapoint
