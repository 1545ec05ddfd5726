#include "bindings.hpp"

PYBIND11_MODULE(_core, m) {
  using namespace viapoint::python;
  m.doc() =
      "The C++ core of viapoint. Use the package `viapoint`; this module is its private part.";
  m.attr("__version__") = VIAPOINT_VERSION;
  bind_error(m);
  bind_core(m);
  bind_robot(m);
  bind_calibration(m);
  bind_path(m);
  bind_program(m);
  bind_planning(m);
  bind_motion_file(m);
  bind_stream(m);
  bind_realtime(m);
  bind_rtde(m);
  bind_profile(m);
  auto profile = m.attr("profile").cast<pybind11::module_>();
  bind_state_to_state(profile);
}
