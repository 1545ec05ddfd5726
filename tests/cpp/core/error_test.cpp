#include "viapoint/core/error.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace viapoint {
namespace {

TEST(ErrorCode, HasAnOwnNameEach) {
  std::set<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(ErrorCode::kInternal); ++i) {
    const std::string_view name = to_string(static_cast<ErrorCode>(i));
    EXPECT_NE(name, "unknown") << i;
    EXPECT_TRUE(names.insert(name).second) << name;
  }
}

TEST(Problem, DescribesPlaceFaultAndWaysOut) {
  Problem problem;
  problem.file = "cell.py";
  problem.line = 12;
  problem.message = "joint 4 leaves its limit";
  problem.ways_out = {"movej", "another pose"};
  EXPECT_EQ(problem.describe(),
            "cell.py:12: joint 4 leaves its limit\n  way out: movej\n  way out: another pose");
  EXPECT_EQ(MotionError(problem).what(), problem.describe());
}

}  // namespace
}  // namespace viapoint
