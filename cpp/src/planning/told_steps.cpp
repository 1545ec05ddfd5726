#include "planning/told_steps.hpp"

#include <algorithm>

#include "planning/itinerary.hpp"

namespace viapoint::planning {

void ToldSteps::note(const Leg& leg) {
  for (Told& told : told_) {
    if (told.step != leg.step) continue;
    told.position_deviation = leg.position_deviation;
    told.angle_deviation = leg.angle_deviation;
  }
}

void ToldSteps::drop_before(int step) {
  while (told_.size() > 1 && told_.front().step < step) told_.pop_front();
}

void ToldSteps::add_deviations(Certificate& certificate, int first, int last) const {
  for (const Told& told : told_) {
    if (told.step < first) continue;
    if (told.step > last) break;
    certificate.path_deviation = std::max(certificate.path_deviation, told.position_deviation);
    certificate.angle_deviation = std::max(certificate.angle_deviation, told.angle_deviation);
  }
}

void ToldSteps::locate(Problem& problem) const {
  for (const Told& told : told_) {
    if (told.step == problem.move.value_or(-1)) {
      planning::locate(problem, told.source, told.step);
    }
  }
}

}  // namespace viapoint::planning
