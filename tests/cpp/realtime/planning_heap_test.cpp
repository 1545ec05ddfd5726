// What may be called in the cycle though it belongs to another module.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "problem_count.hpp"
#include "realtime/no_allocation_scope.hpp"
#include "viapoint/profile/state_to_state.hpp"

namespace viapoint {
namespace {

TEST(StateToState, LeavesTheHeapAloneWhereverItIsPlannedAndRead) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  StateToState motion;
  int solved = 0;
  const NoAllocationScope scope;
  for (int k = 0; k < problems(20000); ++k) {
    std::array<AxisState, 7> start, end;
    std::array<AxisLimits, 7> limits;
    for (std::size_t i = 0; i < 7; ++i) {
      start[i] = {unit(random), unit(random), unit(random), 0.0};
      end[i] = {unit(random), 0.3 * unit(random), 0.3 * unit(random), 0.0};
      limits[i] = AxisLimits::symmetric(1.2, 3.0, 10.0);
      if (k % 4 == 1) limits[i].position_max = 1.3;
      if (k % 4 == 2) limits[i].position_min = -1.3;
    }
    StateToStateOptions options;
    if (k % 3 == 0) options.synchronization = Synchronization::kNone;
    if (k % 5 == 0) options.cycle = 0.002;
    if (motion.plan(start, end, limits, options) != MoveStatus::kSolved) continue;
    ++solved;
    if (motion.at(0.5 * motion.duration()).q.size() != 7) break;
  }
  EXPECT_EQ(scope.calls(), 0U);
  EXPECT_GT(solved, problems(5000));
}

}  // namespace
}  // namespace viapoint
