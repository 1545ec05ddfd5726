#include "kinematics/angle_lanes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace viapoint {
namespace {

constexpr double kTanEighth = std::numbers::sqrt2 - 1.0;  ///< tan π/8
constexpr double kQuarter = std::numbers::pi / 4.0;
constexpr double kQuarterRest = 3.0616169978683830e-17;  ///< π/4 less its double

/// (atan t − t)/t³ as a polynomial in t², interpolated at the Chebyshev nodes of [0, tan² π/8]; the
/// share of atan t that it misses is below 5e-18.
constexpr std::array kArctangent{-0.3333333333333333,  0.1999999999999552,   -0.14285714284666542,
                                 0.11111111015256361,  -0.09090904578123903, 0.07692183190826087,
                                 -0.06664511447381948, 0.0585814891280221,   -0.05085449737940259,
                                 0.03923165829558718,  -0.019176887119062243};

}  // namespace

// One straight line of arithmetic, so that the compiler computes several angles at once.
void angles_of(std::span<const double> sines, std::span<const double> cosines,
               std::span<double> angles) noexcept {
  for (size_t i = 0; i < angles.size(); ++i) {
    const double across = std::abs(sines[i]);
    const double along = std::abs(cosines[i]);
    const double more = std::max(across, along);
    const double less = std::min(across, along);
    // Within π/8 of an axis, or of a diagonal: tan(θ − π/4) = (tan θ − 1)/(tan θ + 1).
    const double difference = less - more;
    const double sum = less + more;
    const bool diagonal = less > kTanEighth * more;
    const double top = diagonal ? difference : less;
    const double bottom = std::max(diagonal ? sum : more, 1e-300);
    const double tangent = top / bottom;
    const double square = tangent * tangent;
    double series = kArctangent.back();
    for (size_t k = kArctangent.size() - 1; k-- > 0;) series = series * square + kArctangent[k];
    const double part = tangent + tangent * square * series;
    // angle = quarters · π/4 ± part.
    const bool steep = across > along;
    const bool back = cosines[i] < 0.0;
    double quarters = diagonal ? 1.0 : 0.0;
    quarters = steep ? 2.0 - quarters : quarters;
    quarters = back ? 4.0 - quarters : quarters;
    const double signed_part = steep != back ? -part : part;
    const double angle = quarters * kQuarter + (signed_part + quarters * kQuarterRest);
    angles[i] = std::copysign(angle, sines[i]);
  }
}

}  // namespace viapoint
