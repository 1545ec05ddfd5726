/// @file
/// Rings of joints in a URDF, before liburdfdom gets it.
#pragma once

#include <optional>
#include <string>

namespace viapoint {

/// A link that is carried by itself, and the joint that carries it.
struct UrdfRing {
  std::string link, joint;
};

/// Finds a ring among the joints of a URDF, if there is one. liburdfdom lets one beside the root
/// pass, and never gives back the links of a ring, which own one another. What is no XML, and
/// joints that lack a parent or a child, are left for it to refuse.
/// @pre the depth of `text` is bounded (xml_extent): the parser calls itself for every element
[[nodiscard]] std::optional<UrdfRing> urdf_ring(const std::string& text);

}  // namespace viapoint
