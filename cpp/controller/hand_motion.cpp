#include "controller/hand_motion.hpp"

#include <iterator>
#include <utility>

#include "viapoint/core/error.hpp"
#include "viapoint/core/number_text.hpp"

namespace viapoint::controller {

GuidingHand& HandMotion::hand() const {
  if (hand_ != nullptr) return *hand_;
  throw MotionError(ErrorCode::kBadArgument, "the drive is a real one: a real hand guides its arm",
                    {"guide the arm; \"guided\" tells whether its drives let it be"});
}

void HandMotion::add(std::size_t offset, std::vector<JointVector> positions) {
  static_cast<void>(hand());
  const std::lock_guard lock(mutex_);
  if (offset == 0) pending_.clear();
  if (offset != pending_.size()) {
    throw MotionError(ErrorCode::kBadArgument,
                      "the positions from " + std::to_string(offset) + " on came where " +
                          std::to_string(pending_.size()) + " were there",
                      {"send them again, from the first one on"});
  }
  const std::size_t count = offset + positions.size();
  if (count > kMaxPositions) {
    throw MotionError(ErrorCode::kBadArgument,
                      "the hand takes the arm through " + std::to_string(count) +
                          " positions or more; allowed are " + std::to_string(kMaxPositions),
                      {"guide the arm several times, one after the other"});
  }
  std::move(positions.begin(), positions.end(), std::back_inserter(pending_));
}

void HandMotion::begin(ArmHost& host, const std::string& token) {
  GuidingHand& taking = hand();
  host.admit_hand(token, [&](const JointVector& measured) {
    std::unique_lock lock(mutex_);
    std::vector<JointVector> way = std::exchange(pending_, {});
    lock.unlock();
    if (!way.empty()) {
      const double off = (way.front() - measured).cwiseAbs().maxCoeff();
      if (!(off <= kReach)) {
        throw MotionError(ErrorCode::kBadArgument,
                          "the hand begins " + number_text(off) +
                              " rad or m from where the arm stands; allowed are " +
                              number_text(kReach),
                          {"begin where the arm is measured"});
      }
    }
    taking.guide(std::move(way));
  });
}

void HandMotion::let_go() { hand().let_go(); }

}  // namespace viapoint::controller
