#include <string>
#include <string_view>

#include "cpp/rtde/rtde_fixture.hpp"
#include "fuzz/broken_promise.hpp"
#include "fuzz/targets.hpp"
#include "rtde/session.hpp"

namespace viapoint::fuzz {

/// The first byte says in what pieces the others come.
void rtde(std::string_view bytes) {
  using namespace viapoint::rtde;
  constexpr double kCycle = 0.002;
  if (bytes.empty()) return;
  const std::size_t piece = 1 + static_cast<unsigned char>(bytes.front());
  bytes.remove_prefix(1);
  ShownArm arm;
  Session session(arm, kCycle);
  ArmView view;
  view.cycle = arm.cycle;
  while (!bytes.empty()) {
    const std::string answers = session.receive(bytes.substr(0, piece));
    bytes.remove_prefix(std::min(piece, bytes.size()));
    promise(packages_in(answers).has_value(), "an answer that is no package");
    promise(!arm.override_share || (*arm.override_share >= 0.0 && *arm.override_share <= 1.0),
            "a speed slider beyond its ends");
    promise(arm.outputs < (std::uint64_t{1} << 18), "an output that clients have not");
    promise(!session.is_started() || (session.has_greeted() && !session.is_broken()),
            "data for a client that has not agreed on the protocol");
    view.time += kCycle;
    if (!session.is_due(view.time)) continue;
    const auto data = packages_in(session.data(view));
    promise(data && data->size() == 1 && data->front().type == 'U', "data that are no package");
  }
}

}  // namespace viapoint::fuzz
