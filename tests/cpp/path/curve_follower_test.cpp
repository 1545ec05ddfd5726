// Joints on a curve: their derivatives are those of the way they really go.
#include "path/curve_follower.hpp"

#include <gtest/gtest.h>

#include "path/insertion_checks.hpp"
#include "path/random_curves.hpp"
#include "problem_count.hpp"

namespace viapoint {
namespace {

struct Held {
  const char* name;
  ForwardKinematics (*arm)();
  Hold hold;
};

class CurveFollowing : public ::testing::TestWithParam<Held> {};

// The joints follow the field q' = f(s, q); its change along itself is q''.
TEST_P(CurveFollowing, SecondDerivativeIsTheChangeOfTheFirst) {
  const ForwardKinematics arm = GetParam().arm();
  const JointLimits range = testing::range_of(arm);
  InsertionOptions options;
  options.hold = GetParam().hold;
  int compared = 0;
  for (unsigned seed = 0; seed < problems(2000U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const JointVector start = 0.6 * testing::random_joints(random, range);
    const auto curve = testing::random_curve(arm, random, start, options.hold);
    const CurveFollower follower(arm, *curve, start, options);
    const double h = 1e-4 * curve->length();
    // The field at an s beside: where q', q'' lead, up to the third order.
    const PathPoint from = follower.derivatives(0.0, start).point;
    const auto beside = [&](double s) {
      const auto knot = follower.solve(s, from.q + s * (from.q1 + 0.5 * s * from.q2));
      return knot ? std::optional<PathPoint>(knot->point) : std::nullopt;
    };
    const auto near = beside(h);
    const auto far = beside(2.0 * h);
    const double size = from.q2.norm() + from.q1.norm() / curve->length();
    if (!near || !far || size * curve->length() > 20.0) continue;  // by a singularity all is wild
    const JointVector change = (-3.0 * from.q1 + 4.0 * near->q1 - far->q1) / (2.0 * h);
    ASSERT_LT((change - from.q2).norm(), 2e-3 * size);
    ++compared;
  }
  EXPECT_GT(compared, problems(500));
}

INSTANTIATE_TEST_SUITE_P(Arms, CurveFollowing,
                         ::testing::Values(Held{"puma560", testing::puma560, Hold::kPose},
                                           Held{"panda", testing::panda, Hold::kPose},
                                           Held{"puma560_axis", testing::puma560, Hold::kAxis},
                                           Held{"panda_axis", testing::panda, Hold::kAxis},
                                           Held{"torch_axis", testing::torch, Hold::kAxis},
                                           Held{"five_axis", testing::five_joints, Hold::kAxis},
                                           Held{"ur5e_position", testing::ur5e, Hold::kPosition}),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace viapoint
