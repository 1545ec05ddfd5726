/// @file
/// An arm for RTDE that nothing moves but the test, and what its clients send.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rtde/wire.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"
#include "viapoint/rtde/rtde_arm.hpp"

namespace viapoint::rtde {

/// Six joints in a row about z, y, y, z, y, z, a tenth of a metre apart.
inline ForwardKinematics six_axes() {
  std::vector<ChainJoint> chain(6);
  for (std::size_t i = 0; i < chain.size(); ++i) {
    chain[i].before = Eigen::Translation3d(0.1, 0.0, 0.1) * Pose::Identity();
    chain[i].axis = i == 1 || i == 2 || i == 4 ? Eigen::Vector3d::UnitY().eval()
                                               : Eigen::Vector3d::UnitZ().eval();
  }
  return {chain, Pose::Identity()};
}

struct ShownArm final : RtdeArm {
  ShownArm() {
    for (JointVector* vector : {&cycle.q, &cycle.qd, &cycle.qdd, &cycle.measurement.q}) {
      vector->setZero(6);
    }
  }
  [[nodiscard]] LoopCycle newest_cycle() override { return cycle; }
  void set_override(double share) override { override_share = share; }
  void switch_outputs(std::uint64_t mask, std::uint64_t values) override {
    outputs = (outputs & ~mask) | (values & mask);
    ++switched;
  }

  LoopCycle cycle;
  std::optional<double> override_share;
  std::uint64_t outputs = 0;
  int switched = 0;
};

struct Package {
  char type = '?';
  Bytes payload;
  bool operator==(const Package&) const = default;
};

/// Splits what a server has sent; nullopt where it is no whole number of packages.
inline std::optional<std::vector<Package>> packages_in(std::string_view bytes) {
  std::vector<Package> packages;
  while (!bytes.empty()) {
    if (bytes.size() < kHeaderBytes) return std::nullopt;
    const std::size_t length = take<std::uint16_t>(bytes);
    const char type = take<char>(bytes);
    if (length < kHeaderBytes || length - kHeaderBytes > bytes.size()) return std::nullopt;
    packages.push_back({type, Bytes(bytes.substr(0, length - kHeaderBytes))});
    bytes.remove_prefix(length - kHeaderBytes);
  }
  return packages;
}

inline Bytes greeting() { return package(PackageType::kProtocolVersion, {"\0\2", 2}); }

inline Bytes output_setup(double hertz, std::string_view names) {
  Bytes payload;
  put(payload, hertz);
  payload += names;
  return package(PackageType::kSetupOutputs, payload);
}

inline Bytes input_setup(std::string_view names) {
  return package(PackageType::kSetupInputs, names);
}

/// Values of an input recipe, in order.
template <typename... T>
Bytes told(std::uint8_t recipe, T... values) {
  Bytes payload;
  put(payload, recipe);
  (put(payload, values), ...);
  return package(PackageType::kData, payload);
}

}  // namespace viapoint::rtde
