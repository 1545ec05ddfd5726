#include "planning/section.hpp"

#include <utility>

#include "planning/path_timer.hpp"
#include "planning/section_builder.hpp"

namespace viapoint::planning {

std::vector<Section> build_sections(const RobotModel& robot, std::span<const Leg> legs) {
  SectionBuilder builder(robot);
  for (const Leg& leg : legs) builder.add(leg);
  builder.end();
  std::vector<Section> sections;
  for (SectionPart& part : builder.take()) {
    sections.push_back(time_section(robot, part.path));
    sections.back().corners = std::move(part.corners);
  }
  return sections;
}

double duration_of(std::span<const TrajectoryPiece> pieces) {
  double sum = 0.0;
  for (const TrajectoryPiece& piece : pieces) sum += piece.duration;
  return sum;
}

}  // namespace viapoint::planning
