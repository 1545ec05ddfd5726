/// @file
#pragma once

#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/support/byte_buffer.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <string>

#include "controller/call_lane.hpp"

namespace viapoint::controller {

/// How many answers wait for clients to read them.
struct UnreadBounds {
  std::size_t calls;                  ///< kept however long nobody reads them
  std::chrono::nanoseconds patience;  ///< those beyond are kept for so long
  std::size_t bytes;                  ///< of all together: beyond, the oldest goes, however young
};

/// Does the calls of a service by their names, each in its lane; what a call throws is its refusal.
/// No thread ever waits for a client: one that sends half a message, or reads no answer, holds
/// nothing but memory, and the answers that nobody reads are given up, those given first, where
/// there are too many. Threads: any.
class CallTable final : public grpc::CallbackGenericService {
 public:
  /// Answers one message by another. @throws MotionError, NotInControl
  using Work = std::function<grpc::ByteBuffer(const std::string& peer, const grpc::ByteBuffer&)>;

  explicit CallTable(const UnreadBounds& bounds);
  /// After the server has ended.
  ~CallTable() override;
  CallTable(const CallTable&) = delete;
  CallTable& operator=(const CallTable&) = delete;

  /// Before the server begins.
  /// @param path "/package.Service/Method"; @param lane outlives the server
  void add(std::string path, CallLane& lane, Work work);

  grpc::ServerGenericBidiReactor* CreateReactor(
      grpc::GenericCallbackServerContext* context) override;

 private:
  class Call;
  struct Entry {
    CallLane& lane;
    Work work;
  };

  void note_answer(Call& call, std::size_t bytes);
  /// @pre locked
  [[nodiscard]] bool is_too_much_unread() const;
  void give_up_oldest();
  void remove(const Call& call);

  const UnreadBounds bounds_;
  std::map<std::string, Entry> entries_;
  std::mutex mutex_;  ///< guards what follows
  std::list<Call> under_way_;
  std::list<Call> unread_;  ///< answered, the oldest first
  std::size_t unread_bytes_ = 0;
};

}  // namespace viapoint::controller
