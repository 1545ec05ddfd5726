// viapoint-profile-bench: state-to-state motion in millions.
//   verify COUNT [FIRST]   solves the problems of the seeds FIRST.. and judges every motion
//   worst COUNT            processor time of each of COUNT solutions
//   plan JOINTS COUNT      solves and nothing else, for callgrind
//   rest JOINTS COUNT      the same from rest to rest
// Prints one JSON object; failures of `verify` go before it, one line each.
#include <array>
#include <charconv>
#include <cstdint>
#include <ctime>
#include <iostream>
#include <string_view>
#include <vector>

#include "durations.hpp"
#include "json_line.hpp"
#include "profile/state_judge.hpp"
#include "profile/state_problems.hpp"

namespace viapoint::bench {
namespace {

using testing::StateFaults;
using testing::StateProblem;

constexpr std::size_t kJoints = 7;
/// Limits between 1e-3 and 1e3.
constexpr double kDecades = 3.0;
/// A motion is sound within these: shares of its size, and of a limit.
constexpr double kMeets = 1e-8, kHolds = 1e-9;
constexpr int kPrinted = 100;

MoveStatus plan(const StateProblem& problem, StateToState& motion) {
  return motion.plan(problem.start, problem.end, problem.limits, problem.options);
}

/// @return whether every problem was solved and every motion sound
bool verify(std::uint64_t first, std::uint64_t count) {
  StateToState motion;
  StateFaults worst;
  std::uint64_t failures = 0, refused = 0;
  double seconds = 0.0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const StateProblem problem = testing::state_problem(seed, kJoints, kDecades);
    MoveStatus status{};
    seconds += time_of([&] { status = plan(problem, motion); });
    std::string why;
    if (status != MoveStatus::kSolved) {
      ++refused;
      why = to_string(status);
    } else {
      const StateFaults faults = testing::judge(problem, motion);
      worst.take(faults);
      why = faults.beyond(kMeets, kHolds);
    }
    if (why.empty()) continue;
    if (++failures <= kPrinted) std::cout << "failed: seed " << seed << ": " << why << "\n";
  }
  JsonLine("profiles", "verified")
      .add("problems", count)
      .add("first_seed", first)
      .add("joints", kJoints)
      .add("decades", 2.0 * kDecades)
      .add("failures", failures)
      .add("refused", refused)
      .add("worst_position", worst.position)
      .add("worst_velocity", worst.velocity)
      .add("worst_acceleration", worst.acceleration)
      .add("worst_velocity_limit", worst.velocity_limit)
      .add("worst_acceleration_limit", worst.acceleration_limit)
      .add("worst_jerk_limit", worst.jerk_limit)
      .add("worst_line", worst.line)
      .add("worst_sampled", worst.sampled)
      .add("worst_duration", worst.duration)
      .add("us_per_solution", 1e6 * seconds / static_cast<double>(count));
  return failures == 0;
}

/// Processor time of this thread [s]: other programs on the machine do not count.
double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Every solution is timed; an outlier is solved again, since interrupts count as the thread's own
/// time: what remains the second time is the solver's.
void worst_case(std::uint64_t count) {
  Durations once, empty;
  once.reserve(count);
  StateToState motion;
  double worst = 0.0, worst_twice = 0.0;
  std::uint64_t worst_seed = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double begin = processor_time();
    empty.add(processor_time() - begin);
  }
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    const StateProblem problem = testing::state_problem(seed, kJoints, kDecades);
    const auto timed = [&] {
      const double begin = processor_time();
      (void)plan(problem, motion);
      return processor_time() - begin;
    };
    const double first = timed();
    once.add(first);
    worst = std::max(worst, first);
    if (first <= worst_twice) continue;
    const double again = std::min(first, timed());
    if (again > worst_twice) {
      worst_twice = again;
      worst_seed = seed;
    }
  }
  JsonLine("profiles", "worst_case")
      .add("solutions", once.count())
      .add("joints", kJoints)
      .add("p50_us", 1e6 * once.quantile(0.5))
      .add("p99_us", 1e6 * once.quantile(0.99))
      .add("p99_99_us", 1e6 * once.quantile(0.9999))
      .add("max_us", 1e6 * worst)
      .add("max_repeated_us", 1e6 * worst_twice)
      .add("max_repeated_seed", worst_seed)
      .add("clock_us", 1e6 * empty.quantile(0.5));
}

void plan_only(std::size_t joints, std::uint64_t count, bool at_rest) {
  StateToState motion;
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    StateProblem problem = testing::state_problem(seed, joints, kDecades);
    for (std::size_t i = 0; at_rest && i < joints; ++i) {
      problem.start[i] = {problem.start[i].q, 0.0, 0.0, 0.0};
      problem.end[i] = {problem.end[i].q, 0.0, 0.0, 0.0};
    }
    if (plan(problem, motion) == MoveStatus::kSolved) sum += motion.duration();
  }
  JsonLine("profiles", "planned")
      .add("joints", joints)
      .add("solutions", count)
      .add("checksum", sum);
}

/// The number in an argument; 0 where it is none.
std::uint64_t number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? value : 0;
}

int run(const std::vector<std::string_view>& arguments) {
  const auto is = [&](std::string_view name, std::size_t least, std::size_t most) {
    return !arguments.empty() && arguments[0] == name && arguments.size() >= least &&
           arguments.size() <= most && number(arguments[1]) > 0;
  };
  if (is("verify", 2, 3)) {
    return verify(arguments.size() > 2 ? number(arguments[2]) : 0, number(arguments[1])) ? 0 : 1;
  }
  if (is("worst", 2, 2)) {
    worst_case(number(arguments[1]));
    return 0;
  }
  for (const bool at_rest : {false, true}) {
    if (!is(at_rest ? "rest" : "plan", 3, 3)) continue;
    if (number(arguments[1]) > static_cast<std::uint64_t>(kMaxJoints)) break;
    plan_only(number(arguments[1]), number(arguments[2]), at_rest);
    return 0;
  }
  std::cerr << "usage: viapoint-profile-bench verify COUNT [FIRST] | worst COUNT | "
               "plan|rest JOINTS COUNT\n";
  return 2;
}

}  // namespace
}  // namespace viapoint::bench

int main(int argc, char** argv) { return viapoint::bench::run({argv + 1, argv + argc}); }
