/// @file
#pragma once

#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/support/byte_buffer.h>

#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <string>

#include "controller/call_lane.hpp"

namespace viapoint::controller {

/// Does the calls of a service by their names, each in its lane; what a call throws is its refusal.
/// No thread ever waits for a client: one that sends half a message, or reads no answer, holds
/// nothing but memory, and the answers that nobody reads are given up, those given first, where
/// there are too many. Threads: any.
class CallTable final : public grpc::CallbackGenericService {
 public:
  /// Answers one message by another. @throws MotionError, NotInControl
  using Work = std::function<grpc::ByteBuffer(const std::string& peer, const grpc::ByteBuffer&)>;

  /// @param most_unread answers kept for clients to read [>= 1]
  explicit CallTable(std::size_t most_unread);
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

  void note_answer(Call& call);
  void remove(const Call& call);

  const std::size_t most_unread_;
  std::map<std::string, Entry> entries_;
  std::mutex mutex_;  ///< guards what follows
  std::list<Call> under_way_;
  std::list<Call> unread_;  ///< answered, the oldest first
};

}  // namespace viapoint::controller
