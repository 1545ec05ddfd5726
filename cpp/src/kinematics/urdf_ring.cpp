#include "kinematics/urdf_ring.hpp"

#include <tinyxml.h>

#include <map>
#include <set>
#include <utility>
#include <vector>

namespace viapoint {
namespace {

struct Edge {
  std::string parent, joint;
};
/// What carries each link.
using Carriers = std::map<std::string, std::vector<Edge>>;

std::string attribute(const TiXmlElement* element, const char* name) {
  const char* value = element == nullptr ? nullptr : element->Attribute(name);
  return value == nullptr ? "" : value;
}

Carriers carriers_of(const TiXmlElement& robot) {
  Carriers carriers;
  for (const TiXmlElement* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const std::string parent = attribute(joint->FirstChildElement("parent"), "link");
    const std::string child = attribute(joint->FirstChildElement("child"), "link");
    if (parent.empty() || child.empty()) continue;
    carriers[child].push_back({parent, attribute(joint, "name")});
  }
  return carriers;
}

/// Takes away every link whose carriers have all been taken away (Kahn 1962): what is left hangs on
/// rings.
void drop_trees(Carriers& carriers) {
  std::map<std::string, std::vector<std::string>> carried;
  std::map<std::string, std::size_t> left;
  std::vector<std::string> gone;
  for (const auto& [link, edges] : carriers) {
    left[link] = edges.size();
    for (const Edge& edge : edges) {
      if (!carriers.contains(edge.parent) && carried[edge.parent].empty()) {
        gone.push_back(edge.parent);
      }
      carried[edge.parent].push_back(link);
    }
  }
  while (!gone.empty()) {
    const std::string parent = std::move(gone.back());
    gone.pop_back();
    carriers.erase(parent);
    for (const std::string& link : carried[parent]) {
      if (--left[link] == 0) gone.push_back(link);
    }
  }
}

}  // namespace

std::optional<UrdfRing> urdf_ring(const std::string& text) {
  TiXmlDocument document;
  document.Parse(text.c_str());
  const TiXmlElement* robot = document.FirstChildElement("robot");
  if (document.Error() || robot == nullptr) return std::nullopt;
  Carriers carriers = carriers_of(*robot);
  drop_trees(carriers);
  if (carriers.empty()) return std::nullopt;
  std::set<std::string> way;
  std::string link = carriers.begin()->first;
  while (true) {
    // Upward among what is left, until a link comes again.
    for (const Edge& edge : carriers.at(link)) {
      if (!carriers.contains(edge.parent)) continue;
      if (!way.insert(link).second) return UrdfRing{link, edge.joint};
      link = edge.parent;
      break;
    }
  }
}

}  // namespace viapoint
