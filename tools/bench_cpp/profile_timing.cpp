// A plain C face on the solver for tools/bench: called from Python next to its peers, so that each
// is timed in C++ with the same things in the caches.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <limits>

#include "viapoint/profile/state_to_state.hpp"

/// @param problem twelve values a joint: q, v, a of start and end, v_min, v_max, a_min, a_max,
///   j_min, j_max
/// @param sync 0 for synchronisation in time, 1 for the straight line, 2 for none
/// @param duration of the motion [s], or −1 where there is none
/// @return the time of the quickest of `repeats` solutions [s]
extern "C" double viapoint_time_plan(const double* problem, int joints, int sync, int repeats,
                                     double* duration) {
  using namespace viapoint;
  using Clock = std::chrono::steady_clock;
  static StateToState motion;
  std::array<AxisState, kMaxJoints> start, end;
  std::array<AxisLimits, kMaxJoints> limits;
  const auto n = static_cast<std::size_t>(joints);
  for (std::size_t i = 0; i < n; ++i, problem += 12) {
    start[i] = {problem[0], problem[1], problem[2], 0.0};
    end[i] = {problem[3], problem[4], problem[5], 0.0};
    AxisLimits& l = limits[i];
    l.velocity_min = problem[6];
    l.velocity_max = problem[7];
    l.acceleration_min = problem[8];
    l.acceleration_max = problem[9];
    l.jerk_min = problem[10];
    l.jerk_max = problem[11];
  }
  StateToStateOptions options;
  constexpr std::array kSync{Synchronization::kTime, Synchronization::kLine,
                             Synchronization::kNone};
  options.synchronization = kSync.at(static_cast<std::size_t>(sync));
  double best = std::numeric_limits<double>::infinity();
  *duration = -1.0;
  for (int i = 0; i < repeats; ++i) {
    const auto begin = Clock::now();
    const MoveStatus status =
        motion.plan({start.data(), n}, {end.data(), n}, {limits.data(), n}, options);
    best = std::min(best, std::chrono::duration<double>(Clock::now() - begin).count());
    if (status == MoveStatus::kSolved) *duration = motion.duration();
  }
  return best;
}
