/// @file
/// How fast a section can about be driven, by samples: what its grid is laid out by.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "trajectory/path_timing_course.hpp"

namespace viapoint::path_timing {

/// Samples of one stretch at most.
inline constexpr std::size_t kMostPlaces = 21;

/// What the limits allow at one place, by the simplest of arguments.
struct Sample {
  double s;
  double z;  ///< ṡ^{3/2} at which a constant speed keeps every limit; after the sweeps, reachable
  double change;        ///< |s̈| where q'' does not count
  double jerk;          ///< |s⃛| where q'' and q''' do not count
  double growth = 0.0;  ///< of z with s, likewise
  double width = 0.0;   ///< w
  /// z that a ceiling on the speed allows, where that rules.
  double top = std::numeric_limits<double>::infinity();

  /// The ceiling differs by as much between pieces as their tool rates are precise.
  [[nodiscard]] bool cruises() const { return z >= (1.0 - 1e-3) * top; }
};

/// Of a whole course.
struct Samples {
  std::vector<Sample> all;
  std::vector<size_t> first;  ///< of each stretch, and the end

  [[nodiscard]] const Sample* of(size_t stretch) const { return &all[first[stretch]]; }
  [[nodiscard]] size_t parts(size_t stretch) const {
    return first[stretch + 1] - first[stretch] - 1;
  }
};

/// The speed swept forwards from rest and backwards to it, and how far it stays about the same: w
/// = ṡ^{3/2} / √(9/2 s⃛) along a motion of constant jerk, more where acceleration is steady or the
/// highest speed is reached. Cost: linear in stretches.
[[nodiscard]] Samples sweep(const Course& course);

}  // namespace viapoint::path_timing
