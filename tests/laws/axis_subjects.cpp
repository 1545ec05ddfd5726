#include "axis_subjects.hpp"

#include <array>

#include "viapoint/profile/axis_law.hpp"
#include "viapoint/profile/axis_timing.hpp"
#include "viapoint/profile/b_spline.hpp"
#include "viapoint/profile/constrained_polynomial.hpp"
#include "viapoint/profile/parabolic_blends.hpp"
#include "viapoint/profile/pseudo_via_points.hpp"
#include "viapoint/profile/quartic_transition.hpp"
#include "viapoint/profile/trapezoid.hpp"
#include "viapoint/profile/via_cubics.hpp"

namespace viapoint::laws {
namespace {

JointVector one(double value) { return JointVector::Constant(1, value); }

Course course_of(const AxisLaw& law, double first, double last, int continuity) {
  Course course;
  course.length = law.duration();
  for (size_t i = 1; i < law.parts().size(); ++i) {
    course.knots.push_back(law.parts()[i].t0 - law.start());
  }
  course.at = [law](double t) -> Derivatives {
    const AxisState state = law.at(law.start() + t);
    return {one(state.q), one(state.qd), one(state.qdd), one(state.qddd)};
  };
  course.first = one(first);
  course.last = one(last);
  course.continuity = continuity;
  return course;
}

constexpr std::array kPoints = {0.3, 1.4, -0.6, 0.9};
constexpr std::array kDurations = {1.1, 1.6, 1.3};
constexpr std::array kAcceleration = {20.0};

AxisLaw septic() {
  constexpr std::array kRestToRest{
      Condition{1, 0, 0.2},  Condition{1, 1, 0.0}, Condition{1, 2, 0.0}, Condition{1, 3, 0.0},
      Condition{3, 0, -1.1}, Condition{3, 1, 0.0}, Condition{3, 2, 0.0}, Condition{3, 3, 0.0}};
  return AxisLaw({constrained_polynomial(kRestToRest)});
}

AxisLaw through_points() {
  constexpr std::array kThrough{ThroughPoint{1, 0.2, 0.25}, ThroughPoint{2, -0.1, 0.3}};
  const PseudoViaPoints pseudo = pseudo_via_points(kPoints, kDurations, kThrough);
  return blended_lines(pseudo.points, pseudo.durations, kAcceleration, pseudo.middles).law;
}

AxisLaw spline_of_degree(int degree) {
  const InterpolatingSpline spline =
      spline_through(kPoints, kDurations, degree, {0, 0.4, -1.0, 0}, {0, -0.3, 0.5, 0});
  return b_spline(spline.control_points, spline.knots, degree);
}

/// The second of two axes: the first takes its own time.
AxisLaw second_axis(AxisTiming timing) {
  const std::array laws{AxisLaw(rest_to_rest(2.5, 1.0, 4.0, 30.0)),
                        AxisLaw(rest_to_rest(-1.0, 1.0, 4.0, 30.0))};
  return timed_together(laws, timing)[1];
}

}  // namespace

std::vector<Subject<Course>> axis_courses() {
  return {
      {"Cubic",
       [] {
         return course_of(AxisLaw({cubic({0.2, 1, 0, 0}, {-1, -2, 0, 0}, 2, 3.5)}), 0.2, -1, 2);
       }},
      {"Quintic",
       [] {
         return course_of(AxisLaw({quintic({0.2, 1, 3, 0}, {-1, -2, 1, 0}, 2, 3.5)}), 0.2, -1, 2);
       }},
      {"Lspb", [] { return course_of(lspb(1, -2, 1.5).law, 1, -2, 1); }},
      {"BangBang", [] { return course_of(bang_bang(1, -2, 3).law, 1, -2, 1); }},
      {"JerkLimited",
       [] { return course_of(AxisLaw(rest_to_rest(2.5, 1.0, 4.0, 30.0)), 0, 2.5, 2); }},
      {"QuarticTransitions",
       [] {
         return course_of(quartic_transitions(kPoints, kDurations, 0.2), kPoints.front(),
                          kPoints.back(), 2);
       }},
      {"ParabolicBlends",
       [] {
         return course_of(blended_lines(kPoints, kDurations, kAcceleration).law, kPoints.front(),
                          kPoints.back(), 1);
       }},
      {"ViaCubics",
       [] {
         return course_of(via_cubics(kPoints, kDurations, slope_velocities(kPoints, kDurations)),
                          kPoints.front(), kPoints.back(), 1);
       }},
      {"CubicSpline",
       [] {
         return course_of(via_cubics(kPoints, kDurations, spline_velocities(kPoints, kDurations)),
                          kPoints.front(), kPoints.back(), 2);
       }},
      {"NaturalSpline",
       [] {
         return course_of(
             via_cubics(kPoints, kDurations, natural_spline_velocities(kPoints, kDurations)),
             kPoints.front(), kPoints.back(), 2);
       }},
      {"PeriodicSpline",
       [] {
         return course_of(
             via_cubics(kPoints, kDurations, periodic_spline_velocities(kPoints, kDurations)),
             kPoints.front(), kPoints.back(), 2);
       }},
      {"Septic", [] { return course_of(septic(), 0.2, -1.1, 3); }},
      {"QuickestTrapezoid",
       [] { return course_of(quickest_trapezoid(1, -2, 2, 3).law, 1, -2, 1); }},
      {"ThroughPoints",
       [] { return course_of(through_points(), kPoints.front(), kPoints.back(), 1); }},
      {"Bezier",
       [] { return course_of(bezier(kPoints, 2, 3.5), kPoints.front(), kPoints.back(), 3); }},
      {"BSpline",
       [] {
         constexpr std::array kMore = {0.3, 1.4, -0.6, 0.9, 2.0, 0.1, 0.0};
         return course_of(b_spline(kMore, clamped_knots(kMore.size(), 4, 1, 5), 4), 0.3, 0.0, 3);
       }},
      {"CubicBSplineThroughPoints",
       [] { return course_of(spline_of_degree(3), kPoints.front(), kPoints.back(), 2); }},
      {"QuinticBSplineThroughPoints",
       [] { return course_of(spline_of_degree(5), kPoints.front(), kPoints.back(), 3); }},
      {"SequentialAxis", [] { return course_of(second_axis(AxisTiming::kSequential), 0, -1, 2); }},
      {"SimultaneousAxis",
       [] { return course_of(second_axis(AxisTiming::kSimultaneous), 0, -1, 2); }},
      {"SynchronisedAxis",
       [] { return course_of(second_axis(AxisTiming::kSynchronised), 0, -1, 2); }},
  };
}

}  // namespace viapoint::laws
