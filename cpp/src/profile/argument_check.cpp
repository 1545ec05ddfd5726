#include "profile/argument_check.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

namespace viapoint {
namespace {

std::string indexed(const char* what, size_t i) {
  return std::string(what) + "[" + std::to_string(i) + "]";
}

void check_finite(double value, const std::string& what) {
  if (std::isfinite(value)) return;
  refuse(what + " is " + written(value) + "; it must be a finite number", value, 0.0);
}

void check_positive(double value, const std::string& what) {
  if (std::isfinite(value) && value > 0.0) return;
  refuse(what + " is " + written(value) + "; it must be finite and greater than 0", value, 0.0);
}

}  // namespace

std::string written(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", value);
  return text;
}

void refuse(const std::string& message, double value, double limit,
            std::vector<std::string> ways_out) {
  Problem problem;
  problem.code = ErrorCode::kBadArgument;
  problem.message = message;
  problem.ways_out = std::move(ways_out);
  problem.value = value;
  problem.limit = limit;
  throw MotionError(std::move(problem));
}

void require_finite(double value, const char* what) { check_finite(value, what); }
void require_positive(double value, const char* what) { check_positive(value, what); }

void require_finite(std::span<const double> values, const char* what) {
  for (size_t i = 0; i < values.size(); ++i) check_finite(values[i], indexed(what, i));
}

void require_positive(std::span<const double> values, const char* what) {
  for (size_t i = 0; i < values.size(); ++i) check_positive(values[i], indexed(what, i));
}

void require_segments(size_t points, size_t segments, const char* what) {
  if (points < 2) {
    refuse("there are " + std::to_string(points) + " points; a motion needs at least 2",
           static_cast<double>(points), 2.0);
  }
  if (segments + 1 != points) {
    refuse(std::to_string(points) + " points have " + std::to_string(points - 1) +
               " segments between them, but " + std::to_string(segments) + " " + what +
               " were given",
           static_cast<double>(segments), static_cast<double>(points - 1));
  }
}

}  // namespace viapoint
