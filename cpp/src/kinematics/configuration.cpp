#include "viapoint/kinematics/configuration.hpp"

namespace viapoint {
namespace {

bool agrees(int side, int wish) { return side == 0 || wish == 0 || side == wish; }

}  // namespace

bool Configuration::fits(const Configuration& wish) const {
  if (!agrees(shoulder, wish.shoulder) || !agrees(elbow, wish.elbow) ||
      !agrees(wrist, wish.wrist)) {
    return false;
  }
  return wish.turns.size() == 0 || (wish.turns.size() == turns.size() && wish.turns == turns);
}

std::string Configuration::describe() const {
  std::string out;
  const auto add = [&](int side, const char* positive, const char* negative) {
    if (side == 0) return;
    if (!out.empty()) out += ", ";
    out += side > 0 ? positive : negative;
  };
  add(shoulder, "front", "back");
  add(elbow, "up", "down");
  add(wrist, "no flip", "flip");
  if ((turns.array() != 0).any()) {
    out += out.empty() ? "turns" : ", turns";
    for (const int turn : turns) out += " " + std::to_string(turn);
  }
  return out.empty() ? "any" : out;
}

}  // namespace viapoint
