#include "kinematics/planar_lanes.hpp"

#include <algorithm>
#include <cmath>

namespace viapoint {

ShoulderTurns turn_shoulder(double x, double y, double side, double held) {
  ShoulderTurns found;
  const double radius = std::sqrt(x * x + y * y);
  const double inside = radius - std::abs(side);
  found.missing = -inside;
  found.forward = std::sqrt(std::max(inside, 0.0) * (radius + std::abs(side)));
  found.meet = !(found.forward > kMeeting * radius);
  for (const int way : {0, 1}) {
    const double ahead = way == 0 ? found.forward : -found.forward;
    double cosine = x * ahead + y * side;
    double sine = y * ahead - x * side;
    if (radius < kOnAxis) {
      cosine = std::cos(held);
      sine = std::sin(held);
    }
    const double scale = 1.0 / std::sqrt(cosine * cosine + sine * sine);
    found.cosine[way] = cosine * scale;
    found.sine[way] = sine * scale;
  }
  const double off_x = found.cosine[0] * found.forward - found.sine[0] * side - x;
  const double off_y = found.sine[0] * found.forward + found.cosine[0] * side - y;
  found.off_square = off_x * off_x + off_y * off_y;
  return found;
}

}  // namespace viapoint
