#include "controller/call_table.hpp"

#include <grpcpp/support/server_callback.h>
#include <grpcpp/support/status.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <exception>
#include <iterator>
#include <utility>

#include "controller/wire.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/remote/control_seat.hpp"

namespace viapoint::controller {
namespace {

using Context = grpc::GenericCallbackServerContext;
using std::chrono::steady_clock;

/// What gRPC takes for a call besides its messages, about.
constexpr std::size_t kBytesACall = 20U << 10;

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
  // Of one that is answered:
  steady_clock::time_point answered;
  std::size_t bytes = 0;

 private:
  /// From here on it may be gone.
  void answer(const grpc::Status& status) {
    table_.note_answer(*this, reply_.Length());
    if (!status.ok()) return Finish(status);
    StartWriteAndFinish(&reply_, grpc::WriteOptions(), status);
  }

  CallTable& table_;
  Context& context_;
  const Entry* entry_ = nullptr;
  grpc::ByteBuffer request_, reply_;
};

CallTable::CallTable(const UnreadBounds& bounds) : bounds_(bounds) {}

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

void CallTable::note_answer(Call& call, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  unread_.splice(unread_.end(), *call.list, call.place);
  call.list = &unread_;
  call.answered = steady_clock::now();
  call.bytes = kBytesACall + bytes;
  unread_bytes_ += call.bytes;
  while (is_too_much_unread()) give_up_oldest();
}

bool CallTable::is_too_much_unread() const {
  if (unread_.size() <= 1) return false;
  if (unread_bytes_ > bounds_.bytes) return true;
  // A crowd that reads what it asks for has many answers on their way, and none that is old.
  return unread_.size() > bounds_.calls &&
         unread_.back().answered - unread_.front().answered > bounds_.patience;
}

void CallTable::give_up_oldest() {
  Call& oldest = unread_.front();
  under_way_.splice(under_way_.end(), unread_, oldest.place);
  oldest.list = &under_way_;
  unread_bytes_ -= oldest.bytes;
  oldest.give_up();  // its context lives until OnDone has come back, which waits for the lock
}

void CallTable::remove(const Call& call) {
  const std::lock_guard lock(mutex_);
  if (call.list == &unread_) unread_bytes_ -= call.bytes;
  call.list->erase(call.place);
}

}  // namespace viapoint::controller
