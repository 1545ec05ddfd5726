/// @file
/// What reads bytes from outside, one function each. A target takes any bytes at all: it returns
/// when they were taken or refused by name (MotionError), and lets out, as a crash, whatever else
/// happens. What was taken is held against what the reader promises of it.
#pragma once

#include <string_view>

namespace viapoint::fuzz {

/// A program as JSON. What was read is written, and reads back to the same text.
void program(std::string_view bytes);
/// A robot as YAML. Likewise; and its model is made.
void robot_yaml(std::string_view bytes);
/// A robot as URDF. Its model is made.
void robot_urdf(std::string_view bytes);
/// What a client of RTDE says, in pieces. All that is answered is whole packages.
void rtde(std::string_view bytes);
/// A datagram to or from a drive over UDP.
void udp(std::string_view bytes);
/// The configuration of viapoint-controller.
void config(std::string_view bytes);
/// Messages to viapoint-controller, by the first byte: pieces of a motion, or a jog, a wish, a
/// hand's way, a reaction to an input. A motion that is admitted runs, and the guard finds nothing.
void wire(std::string_view bytes);

struct Target {
  std::string_view name;
  void (*run)(std::string_view);
};

inline constexpr Target kTargets[] = {
    {"program", program},
    {"robot_yaml", robot_yaml},
    {"robot_urdf", robot_urdf},
    {"rtde", rtde},
    {"udp", udp},
#ifdef VIAPOINT_REMOTE
    {"config", config},
    {"wire", wire},
#endif
};

}  // namespace viapoint::fuzz
