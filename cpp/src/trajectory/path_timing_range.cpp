#include "trajectory/path_timing_range.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

#include "viapoint/core/error.hpp"

namespace viapoint::path_timing {
namespace {

constexpr double kShortest = 1e-40, kLongest = 1e40;  // [s]

/// The given number that is the most decades away from one.
class Extreme {
 public:
  void consider(double value, const std::string& name, const JointPiece* piece,
                std::optional<int> joint = std::nullopt) {
    const double decades = std::abs(std::log10(value));
    if (std::isinf(value) || decades <= decades_) return;
    decades_ = decades;
    value_ = value;
    name_ = name;
    joint_ = joint;
    if (piece != nullptr) move_ = piece->move;
  }

  [[noreturn]] void refuse(double seconds) const {
    std::ostringstream text;
    text << "This section of path would last about " << seconds << " s; allowed are " << kShortest
         << " to " << kLongest << " s. The most extreme number it depends on is " << name_
         << ", which is " << value_ << '.';
    Problem problem;
    problem.code = ErrorCode::kBadArgument;
    problem.message = text.str();
    problem.ways_out = {"Give a speed, scale and limits nearer to what a machine does."};
    problem.move = move_;
    problem.joint = joint_;
    problem.value = value_;
    throw MotionError(problem);
  }

 private:
  double decades_ = -1.0, value_ = 1.0;
  std::string name_;
  std::optional<int> move_, joint_;
};

Extreme most_extreme(const JointPath& path, const JointLimits& limits) {
  Extreme extreme;
  for (const JointPiece& piece : path.pieces()) {
    extreme.consider(piece.scale, "the scale of limits", &piece);
    extreme.consider(piece.length, "the length of path", &piece);
  }
  const JointPiece* nowhere = nullptr;
  for (int i = 0; i < limits.joints(); ++i) {
    const std::string who = " limit of joint " + std::to_string(i + 1);
    extreme.consider(limits.velocity[i], "the velocity" + who, nowhere, i);
    extreme.consider(limits.acceleration[i], "the acceleration" + who, nowhere, i);
    extreme.consider(limits.jerk[i], "the jerk" + who, nowhere, i);
  }
  return extreme;
}

}  // namespace

bool in_range(double seconds) { return seconds >= kShortest && seconds <= kLongest; }

UniformCeilings within_range(UniformCeilings ceilings, const JointPath& path,
                             const JointLimits& limits) {
  const double length = path.length();
  const double seconds = std::max({length / ceilings.rate, std::sqrt(length / ceilings.change),
                                   std::cbrt(length / ceilings.jerk)});
  // Written so that NaN is out of range.
  const bool positive = ceilings.rate > 0.0 && ceilings.change > 0.0 && ceilings.jerk > 0.0;
  if (!positive || !in_range(seconds)) {
    most_extreme(path, limits).refuse(positive ? seconds : std::numeric_limits<double>::infinity());
  }
  constexpr double kShortestPhase = 1e-13;
  const double phase = kShortestPhase * seconds;
  ceilings.change = std::min(ceilings.change, ceilings.rate / phase);
  ceilings.jerk = std::min(ceilings.jerk, ceilings.change / phase);
  return ceilings;
}

}  // namespace viapoint::path_timing
