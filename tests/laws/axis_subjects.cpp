#include "axis_subjects.hpp"

#include <array>

#include "viapoint/profile/axis_law.hpp"
#include "viapoint/profile/parabolic_blends.hpp"
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
  };
}

}  // namespace viapoint::laws
