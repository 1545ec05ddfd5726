#include "viapoint/profile/axis_timing.hpp"

#include <algorithm>
#include <string>

#include "profile/argument_check.hpp"

namespace viapoint {
namespace {

void require_one_start(std::span<const AxisLaw> laws) {
  if (laws.empty()) refuse("there is no law to time", 0.0, 1.0);
  for (size_t i = 1; i < laws.size(); ++i) {
    if (laws[i].start() == laws[0].start()) continue;
    refuse("law " + std::to_string(i) + " begins at " + written(laws[i].start()) +
               " s, but the first at " + written(laws[0].start()) + " s",
           laws[i].start(), laws[0].start());
  }
}

std::vector<AxisLaw> one_after_the_other(std::span<const AxisLaw> laws) {
  std::vector<AxisLaw> moved;
  double begin = laws[0].start();
  for (const AxisLaw& law : laws) {
    moved.push_back(delayed(law, begin - law.start()));
    begin = moved.back().end();
  }
  for (AxisLaw& law : moved) law = held(law, laws[0].start(), begin);
  return moved;
}

}  // namespace

std::vector<AxisLaw> timed_together(std::span<const AxisLaw> laws, AxisTiming timing) {
  require_one_start(laws);
  if (timing == AxisTiming::kSequential) return one_after_the_other(laws);
  const AxisLaw& slowest = *std::ranges::max_element(laws, {}, &AxisLaw::duration);
  std::vector<AxisLaw> together;
  for (const AxisLaw& law : laws) {
    const bool quicker = law.duration() < slowest.duration();
    if (timing == AxisTiming::kSimultaneous || !quicker) {
      together.push_back(held(law, slowest.start(), slowest.end()));
    } else {
      together.push_back(stretched(law, slowest.end()));
    }
  }
  return together;
}

}  // namespace viapoint
