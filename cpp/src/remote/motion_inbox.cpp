#include "remote/motion_inbox.hpp"

#include <iterator>
#include <string>

#include "viapoint/core/error.hpp"
#include "viapoint/remote/arm_host.hpp"

namespace viapoint {

void MotionInbox::add(std::size_t offset, std::vector<TrajectoryPiece> part) {
  if (offset == 0) clear();
  if (offset != pieces_.size()) {
    throw MotionError(ErrorCode::kBadArgument,
                      "the pieces from " + std::to_string(offset) + " on came where " +
                          std::to_string(pieces_.size()) +
                          " were there: a part is missing, came twice, or is another motion's",
                      {"send the motion again, from its first piece on"});
  }
  const std::size_t count = pieces_.size() + part.size();
  if (count > ArmHost::kMaxPieces) {
    throw MotionError(ErrorCode::kBadArgument,
                      "the motion has " + std::to_string(count) + " pieces or more; allowed are " +
                          std::to_string(ArmHost::kMaxPieces),
                      {"run it as several programs, one after the other"});
  }
  std::move(part.begin(), part.end(), std::back_inserter(pieces_));
}

}  // namespace viapoint
