// The laws of one axis, in the submodule `profile`. viapoint/profile.py lays them over axes.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "bindings.hpp"
#include "viapoint/profile/axis_law.hpp"
#include "viapoint/profile/axis_timing.hpp"
#include "viapoint/profile/b_spline.hpp"
#include "viapoint/profile/constrained_polynomial.hpp"
#include "viapoint/profile/parabolic_blends.hpp"
#include "viapoint/profile/pseudo_via_points.hpp"
#include "viapoint/profile/quartic_transition.hpp"
#include "viapoint/profile/s_curve.hpp"
#include "viapoint/profile/trapezoid.hpp"
#include "viapoint/profile/via_cubics.hpp"

namespace viapoint::python {
namespace {

std::span<const double> values_of(const Array& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

py::array_t<double> sample(const AxisLaw& law, const Array& times) {
  py::array_t<double> out({times.size(), py::ssize_t{4}});
  auto rows = out.mutable_unchecked<2>();
  const double* t = times.data();
  for (py::ssize_t i = 0; i < times.size(); ++i) {
    const AxisState state = law.at(t[i]);
    rows(i, 0) = state.q;
    rows(i, 1) = state.qd;
    rows(i, 2) = state.qdd;
    rows(i, 3) = state.qddd;
  }
  return out;
}

std::array<double, 4> extremes(const AxisLaw& law, int derivative) {
  if (derivative < 0 || derivative > 3) {
    throw MotionError(ErrorCode::kBadArgument,
                      "derivative is " + std::to_string(derivative) + "; it must be 0 to 3");
  }
  const Extremes found = law.extremes(derivative);
  return {found.low, found.low_time, found.high, found.high_time};
}

std::vector<std::tuple<double, double, Polynomial::Coefficients>> parts(const AxisLaw& law) {
  std::vector<std::tuple<double, double, Polynomial::Coefficients>> all;
  for (const Polynomial& part : law.parts()) all.emplace_back(part.t0, part.t1, part.c);
  return all;
}

AxisLaw polynomial(const std::vector<std::tuple<double, int, double>>& conditions) {
  std::vector<Condition> all;
  for (const auto& [t, derivative, value] : conditions) all.push_back({t, derivative, value});
  return AxisLaw({constrained_polynomial(all)});
}

PseudoViaPoints pseudo_points(const Array& points, const Array& durations,
                              const std::vector<std::tuple<std::size_t, double, double>>& through) {
  std::vector<ThroughPoint> all;
  for (const auto& [index, velocity, half_gap] : through) {
    all.push_back({index, velocity, half_gap});
  }
  return pseudo_via_points(values_of(points), values_of(durations), all);
}

Trapezoid any_lspb(double q0, double q1, double duration, std::optional<double> velocity,
                   std::optional<double> blend_time) {
  if (velocity) return lspb_with_velocity(q0, q1, duration, *velocity);
  if (blend_time) return lspb_with_blend_time(q0, q1, duration, *blend_time);
  return lspb(q0, q1, duration);
}

void bind_classes(py::module_& m) {
  py::class_<AxisLaw>(m, "AxisLaw", "The course of one axis: polynomials one after the other.")
      .def_property_readonly("start", &AxisLaw::start, "Time at which it begins [s].")
      .def_property_readonly("end", &AxisLaw::end, "Time at which it ends [s].")
      .def("sample", &sample, py::arg("times"),
           "q and its three derivatives at times (k,), (k, 4); times outside are refused.")
      .def("extremes", &extremes, py::arg("derivative"),
           "Smallest value, its time, largest value, its time, of derivative 0 to 3.")
      .def("parts", &parts, "(t0, t1, coefficients of (t - t0)^k) of each polynomial.")
      .def("delayed", &delayed, py::arg("seconds"), "The same course, later by that.");
  py::enum_<AxisTiming>(m, "AxisTiming", "When the axes of one motion move.")
      .value("sequential", AxisTiming::kSequential)
      .value("simultaneous", AxisTiming::kSimultaneous)
      .value("synchronised", AxisTiming::kSynchronised);
  py::class_<PseudoViaPoints>(m, "PseudoViaPoints", "Through points replaced by two each.")
      .def_readonly("points", &PseudoViaPoints::points)
      .def_readonly("durations", &PseudoViaPoints::durations, "[s]")
      .def_readonly("source", &PseudoViaPoints::source, "The original index of each point.")
      .def_readonly("middles", &PseudoViaPoints::middles, "Segments with a through point inside.");
  py::class_<Trapezoid>(m, "Trapezoid", "A trapezoid of velocity.")
      .def_readonly("law", &Trapezoid::law)
      .def_readonly("velocity", &Trapezoid::velocity, "Of the linear part, signed.")
      .def_readonly("acceleration", &Trapezoid::acceleration, "Of the first blend, signed.")
      .def_readonly("blend_time", &Trapezoid::blend_time, "[s]");
  py::class_<BlendedLines>(m, "BlendedLines", "Lines joined by parabolic blends.")
      .def_readonly("law", &BlendedLines::law)
      .def_readonly("durations", &BlendedLines::durations, "Of the segments [s], (k - 1,).")
      .def_readonly("blend_acceleration", &BlendedLines::blend_acceleration, "Signed, (k,).")
      .def_readonly("blend_time", &BlendedLines::blend_time, "[s], (k,)")
      .def_readonly("linear_velocity", &BlendedLines::linear_velocity, "Signed, (k - 1,).")
      .def_readonly("linear_time", &BlendedLines::linear_time, "[s], (k - 1,)");
}

void bind_point_to_point(py::module_& m) {
  m.def(
      "cubic",
      [](double q0, double q1, double t0, double t1, double v0, double v1) {
        return AxisLaw({cubic({q0, v0, 0.0, 0.0}, {q1, v1, 0.0, 0.0}, t0, t1)});
      },
      py::arg("q0"), py::arg("q1"), py::arg("t0"), py::arg("t1"), py::arg("v0"), py::arg("v1"),
      "The cubic with given position and velocity at both ends.");
  m.def(
      "quintic",
      [](double q0, double q1, double t0, double t1, double v0, double v1, double a0, double a1) {
        return AxisLaw({quintic({q0, v0, a0, 0.0}, {q1, v1, a1, 0.0}, t0, t1)});
      },
      py::arg("q0"), py::arg("q1"), py::arg("t0"), py::arg("t1"), py::arg("v0"), py::arg("v1"),
      py::arg("a0"), py::arg("a1"),
      "The quintic with given position, velocity and acceleration at both ends.");
  m.def("lspb", &any_lspb, py::arg("q0"), py::arg("q1"), py::arg("duration"),
        py::arg("velocity") = py::none(), py::arg("blend_time") = py::none(),
        "Linear segment with parabolic blends, by velocity, by blend time, or neither.");
  m.def("polynomial", &polynomial, py::arg("conditions"),
        "The polynomial of least degree that meets conditions (time, derivative, value).");
  m.def("bang_bang", &bang_bang, py::arg("q0"), py::arg("q1"), py::arg("acceleration"),
        "The quickest move under an acceleration limit.");
  m.def("trapezoid", &quickest_trapezoid, py::arg("q0"), py::arg("q1"), py::arg("velocity"),
        py::arg("acceleration"), "The quickest move under velocity and acceleration limits.");
  m.def("resting", &resting, py::arg("q"), py::arg("t0"), py::arg("t1"), "At rest at q.");
  m.def(
      "timed_together",
      [](const std::vector<AxisLaw>& laws, AxisTiming timing) {
        return timed_together(laws, timing);
      },
      py::arg("laws"), py::arg("timing"), "Several laws on one clock.");
  m.def("rest_to_rest", &s_curve, py::arg("q0"), py::arg("q1"), py::arg("velocity"),
        py::arg("acceleration"), py::arg("jerk"),
        "The quickest move under limits on velocity, acceleration and jerk.");
}

void bind_through_points(py::module_& m) {
  m.def(
      "via_cubics",
      [](const Array& points, const Array& durations, const Array& velocities) {
        return via_cubics(values_of(points), values_of(durations), values_of(velocities));
      },
      py::arg("points"), py::arg("durations"), py::arg("velocities"),
      "One cubic a segment through points with given velocities.");
  m.def(
      "slope_velocities",
      [](const Array& points, const Array& durations, double first, double last) {
        return slope_velocities(values_of(points), values_of(durations), first, last);
      },
      py::arg("points"), py::arg("durations"), py::arg("first"), py::arg("last"),
      "Via velocities by the slope heuristic.");
  m.def(
      "spline_velocities",
      [](const Array& points, const Array& durations, double first, double last) {
        return spline_velocities(values_of(points), values_of(durations), first, last);
      },
      py::arg("points"), py::arg("durations"), py::arg("first"), py::arg("last"),
      "Via velocities that make acceleration continuous.");
  m.def(
      "natural_spline_velocities",
      [](const Array& points, const Array& durations) {
        return natural_spline_velocities(values_of(points), values_of(durations));
      },
      py::arg("points"), py::arg("durations"), "The same with no acceleration at both ends.");
  m.def(
      "periodic_spline_velocities",
      [](const Array& points, const Array& durations) {
        return periodic_spline_velocities(values_of(points), values_of(durations));
      },
      py::arg("points"), py::arg("durations"), "The same with ends that go over into each other.");
}

void bind_lines(py::module_& m) {
  m.def(
      "blended_lines",
      [](const Array& points, const Array& durations, const Array& accelerations,
         const std::vector<std::size_t>& middles) {
        return blended_lines(values_of(points), values_of(durations), values_of(accelerations),
                             middles);
      },
      py::arg("points"), py::arg("durations"), py::arg("accelerations"),
      py::arg("straight_at_middle") = std::vector<std::size_t>{},
      "Linear segments with parabolic blends, durations given.");
  m.def(
      "durations_at_speed",
      [](const Array& points, const Array& speeds, const Array& accelerations) {
        return durations_at_speed(values_of(points), values_of(speeds), values_of(accelerations));
      },
      py::arg("points"), py::arg("speeds"), py::arg("accelerations"),
      "Durations with which the linear parts run at given speeds; 0 between equal points.");
  m.def("parabolic_blend", &parabolic_blend, py::arg("w0"), py::arg("w1"), py::arg("w2"),
        py::arg("before"), py::arg("after"), py::arg("half_width"),
        "Two lines and one parabolic blend of given half width.");
  m.def(
      "quartic_transitions",
      [](const Array& points, const Array& durations, double t_acc) {
        return quartic_transitions(values_of(points), values_of(durations), t_acc);
      },
      py::arg("points"), py::arg("durations"), py::arg("t_acc"),
      "Lines through timed points with quartic transitions.");
  m.def("pseudo_via_points", &pseudo_points, py::arg("points"), py::arg("durations"),
        py::arg("through"), "Two points for every through point (index, velocity, half gap).");
}

void bind_control_points(py::module_& m) {
  m.def(
      "bezier",
      [](const Array& points, double t0, double t1) { return bezier(values_of(points), t0, t1); },
      py::arg("points"), py::arg("t0"), py::arg("t1"), "The Bézier law of control points.");
  m.def(
      "b_spline",
      [](const Array& points, const Array& knots, int degree) {
        return b_spline(values_of(points), values_of(knots), degree);
      },
      py::arg("points"), py::arg("knots"), py::arg("degree"), "The B-spline of control points.");
  m.def("clamped_knots", &clamped_knots, py::arg("points"), py::arg("degree"), py::arg("t0"),
        py::arg("t1"), "Knots with equal spans and both ends degree + 1 times.");
  m.def(
      "spline_through",
      [](const Array& points, const Array& durations, int degree, double v0, double v1, double a0,
         double a1) {
        const InterpolatingSpline spline =
            spline_through(values_of(points), values_of(durations), degree, {0.0, v0, a0, 0.0},
                           {0.0, v1, a1, 0.0});
        return b_spline(spline.control_points, spline.knots, degree);
      },
      py::arg("points"), py::arg("durations"), py::arg("degree"), py::arg("v0"), py::arg("v1"),
      py::arg("a0"), py::arg("a1"), "The B-spline through points.");
}

}  // namespace
}  // namespace viapoint::python

void bind_profile(pybind11::module_& m) {
  pybind11::module_ profile = m.def_submodule("profile", "The laws of one axis.");
  viapoint::python::bind_classes(profile);
  viapoint::python::bind_point_to_point(profile);
  viapoint::python::bind_through_points(profile);
  viapoint::python::bind_lines(profile);
  viapoint::python::bind_control_points(profile);
}
