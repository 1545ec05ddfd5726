#include <cmath>
#include <utility>

#include "profile/argument_check.hpp"
#include "viapoint/profile/axis_law.hpp"

namespace viapoint {
namespace {

/// Velocities up to this share of the law's largest are rounding of rest.
constexpr double kRestRounding = 1e-9;

/// Share of a law by which its parts may come out longer or shorter at another time.
constexpr double kLengthRounding = 1e-6;

void require_rest(const AxisLaw& law, double t, const char* where) {
  const Extremes speed = law.extremes(1);
  const double largest = std::max(std::abs(speed.low), std::abs(speed.high));
  const double here = law.at(t).qd;
  if (std::abs(here) <= kRestRounding * largest) return;
  refuse(std::string("the axis would have to rest ") + where +
             " its law, but the law has a "
             "velocity of " +
             written(here) + " there; it must be 0",
         here, 0.0, {"give a law that starts and ends at rest", "synchronise the axes"});
}

}  // namespace

AxisLaw resting(double q, double t0, double t1) {
  require_finite(q, "q");
  require_finite(t0, "t0");
  require_finite(t1, "t1");
  return AxisLaw({Polynomial{t0, t1, {q}}});
}

AxisLaw delayed(const AxisLaw& law, double seconds) {
  require_finite(seconds, "seconds");
  std::vector<Polynomial> parts = law.parts();
  for (Polynomial& part : parts) {
    const double length = part.t1 - part.t0;
    part.t0 += seconds;
    part.t1 += seconds;
    if (std::abs(part.t1 - part.t0 - length) <= kLengthRounding * law.duration()) continue;
    refuse("at " + written(part.t0) + " s a clock of doubles cannot tell " + written(length) +
               " s apart",
           part.t0, length, {"begin nearer to time 0"});
  }
  return AxisLaw(std::move(parts));
}

AxisLaw stretched(const AxisLaw& law, double end) {
  require_positive(end - law.start(), "the stretched duration");
  const double factor = (end - law.start()) / law.duration();
  std::vector<Polynomial> parts = law.parts();
  for (Polynomial& part : parts) {
    part.t0 = law.start() + factor * (part.t0 - law.start());
    part.t1 = law.start() + factor * (part.t1 - law.start());
    double power = 1.0;
    for (double& c : part.c) {
      if (c != 0.0) c *= power;
      power /= factor;
    }
  }
  parts.back().t1 = end;  // and not what rounding makes of it
  return AxisLaw(std::move(parts));
}

AxisLaw held(const AxisLaw& law, double t0, double t1) {
  require_finite(t0, "t0");
  require_finite(t1, "t1");
  std::vector<Polynomial> parts = law.parts();
  if (t0 < law.start()) {
    require_rest(law, law.start(), "before");
    parts.insert(parts.begin(), Polynomial{t0, law.start(), {law.at(law.start()).q}});
  }
  if (t1 > law.end()) {
    require_rest(law, law.end(), "after");
    parts.push_back(Polynomial{law.end(), t1, {law.at(law.end()).q}});
  }
  return AxisLaw(std::move(parts));
}

}  // namespace viapoint
