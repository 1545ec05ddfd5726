#include "controller/call_table.hpp"

#include <grpcpp/support/server_callback.h>
#include <grpcpp/support/status.h>
#include <spdlog/spdlog.h>

#include <exception>
#include <iterator>
#include <utility>

#include "controller/wire.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/remote/control_seat.hpp"

namespace viapoint::controller {
namespace {

using Context = grpc::GenericCallbackServerContext;

/// The problem goes with the status, for clients that want more than its text.
void tell(const Problem& problem, Context& context) {
  context.AddTrailingMetadata("viapoint-problem-bin", wire_of(problem).SerializeAsString());
}

template <typename Work>
grpc::Status status_after(Context& context, const Work& work) {
  try {
    work();
    return grpc::Status::OK;
  } catch (const NotInControl& error) {
    tell(error.problem(), context);
    return {grpc::StatusCode::PERMISSION_DENIED, error.problem().describe()};
  } catch (const MotionError& error) {
    tell(error.problem(), context);
    return status_of(error.problem());
  } catch (const std::exception& error) {
    spdlog::error("a call failed: {}", error.what());
    Problem problem;
    problem.code = ErrorCode::kInternal;
    problem.message = std::string("the controller could not answer: ") + error.what();
    tell(problem, context);
    return status_of(problem);
  }
}

}  // namespace

/// One call, until gRPC is done with it.
class CallTable::Call final : public grpc::ServerGenericBidiReactor {
 public:
  Call(CallTable& table, Context& context) : table_(table), context_(context) {}

  void begin() {
    const auto entry = table_.entries_.find(context_.method());
    if (entry == table_.entries_.end()) {
      return Finish({grpc::StatusCode::UNIMPLEMENTED, "there is no call " + context_.method()});
    }
    entry_ = &entry->second;
    StartRead(&request_);
  }
  void OnReadDone(bool is_there) override {
    if (!is_there) {
      return answer({grpc::StatusCode::INVALID_ARGUMENT, "the call came without its message"});
    }
    const bool is_taken = entry_->lane.take([this] {
      answer(status_after(context_, [this] { reply_ = entry_->work(context_.peer(), request_); }));
    });
    if (!is_taken) {
      answer({grpc::StatusCode::RESOURCE_EXHAUSTED, "too many calls wait for an answer"});
    }
  }
  void OnDone() override { table_.remove(*this); }
  void give_up() { context_.TryCancel(); }

  std::list<Call>* list = nullptr;  ///< that it is in
  std::list<Call>::iterator place;

 private:
  /// From here on it may be gone.
  void answer(const grpc::Status& status) {
    table_.note_answer(*this);
    if (!status.ok()) return Finish(status);
    StartWriteAndFinish(&reply_, grpc::WriteOptions(), status);
  }

  CallTable& table_;
  Context& context_;
  const Entry* entry_ = nullptr;
  grpc::ByteBuffer request_, reply_;
};

CallTable::CallTable(std::size_t most_unread) : most_unread_(most_unread) {}

CallTable::~CallTable() = default;

void CallTable::add(std::string path, CallLane& lane, Work work) {
  entries_.try_emplace(std::move(path), Entry{lane, std::move(work)});
}

grpc::ServerGenericBidiReactor* CallTable::CreateReactor(Context* context) {
  std::unique_lock lock(mutex_);
  Call& call = under_way_.emplace_back(*this, *context);
  call.list = &under_way_;
  call.place = std::prev(under_way_.end());
  lock.unlock();
  call.begin();
  return &call;  // gRPC ends no call before it has it
}

void CallTable::note_answer(Call& call) {
  const auto move = [](Call& moved, std::list<Call>& to) {
    to.splice(to.end(), *moved.list, moved.place);
    moved.list = &to;
  };
  const std::lock_guard lock(mutex_);
  move(call, unread_);
  if (unread_.size() <= most_unread_) return;
  Call& oldest = unread_.front();
  move(oldest, under_way_);
  oldest.give_up();  // its context lives until OnDone has come back, which waits for the lock
}

void CallTable::remove(const Call& call) {
  const std::lock_guard lock(mutex_);
  call.list->erase(call.place);
}

}  // namespace viapoint::controller
