#include <gtest/gtest.h>

#include "path/insertion_checks.hpp"
#include "problem_count.hpp"
#include "viapoint/path/insertion.hpp"

namespace viapoint {
namespace {

using testing::joints_a;
using testing::joints_b;
using testing::random_line;
using testing::RandomLine;

TEST(InsertCurve, NeedsFewerKnotsThanTaylor) {
  const ForwardKinematics arm = testing::puma560();
  const JointLimits range = testing::puma560_limits();
  const JointLimits free = testing::no_position_limits(6);
  for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
    size_t ours = 0;
    size_t taylors = 0;
    int lines = 0;
    for (unsigned seed = 0; seed < problems(400U); ++seed) {
      const RandomLine line = random_line(arm, range, seed, 0.25);
      InsertionOptions options;
      options.position_tolerance = tolerance;
      options.angle_tolerance = tolerance / 0.3;
      try {
        const Insertion found = insert_curve(arm, free, line.curve, line.start, options);
        const TaylorKnots taylor = taylor_insertion(arm, line.curve, line.start, found.knots.back(),
                                                    tolerance, options.angle_tolerance);
        ours += found.knots.size();
        taylors += taylor.knots.size();
        ++lines;
      } catch (const MotionError&) {
        continue;
      }
    }
    const std::string name = "tolerance_" + std::to_string(tolerance * 1e3) + "_mm";
    RecordProperty(name + "_lines", lines);
    RecordProperty(name + "_knots", std::to_string(ours));
    RecordProperty(name + "_taylor_knots", std::to_string(taylors));
    std::printf("%g mm: %d lines, %zu knots, Taylor %zu\n", tolerance * 1e3, lines, ours, taylors);
    ASSERT_GT(lines, problems(200));
    EXPECT_LT(ours, taylors);
  }
}

TEST(TaylorInsertion, RefusesEndsOnDifferentBranches) {
  const ForwardKinematics arm = testing::puma560();
  const LineCurve curve(arm.pose(joints_a()), arm.pose(joints_b()));
  // The line arrives on the other wrist branch than the printed joints of B.
  try {
    (void)taylor_insertion(arm, curve, joints_a(), joints_b(), 1e-3, 1e-2);
    FAIL() << "different branches must be refused";
  } catch (const MotionError& error) {
    EXPECT_TRUE(error.code() == ErrorCode::kBranchChange || error.code() == ErrorCode::kSingular);
  }
}

}  // namespace
}  // namespace viapoint
