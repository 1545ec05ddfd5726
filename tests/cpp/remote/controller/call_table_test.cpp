// Answers that wait for clients to read them: how many are kept, and which are given up.
#include "controller/call_table.hpp"

#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <grpcpp/support/slice.h>
#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <memory>
#include <string>

namespace viapoint::controller {
namespace {

using std::chrono::hours;
using std::chrono::nanoseconds;
using std::chrono::system_clock;

/// Far beyond what a connection takes for a call that nobody reads.
constexpr std::size_t kLarge = 1U << 20;
constexpr std::size_t kNoEnd = 1U << 30;
constexpr int kCalls = 40;

grpc::ByteBuffer bytes(std::size_t count) {
  const grpc::Slice slice(std::string(count, 'x'));
  return {&slice, 1};
}

/// A server of "/t/Large" and "/t/Small", which answers one call after the other.
class Served {
 public:
  explicit Served(const UnreadBounds& bounds) : table_(bounds) {
    table_.add("/t/Large", lane_, [](const auto&, const auto&) { return bytes(kLarge); });
    table_.add("/t/Small", lane_, [](const auto&, const auto&) { return bytes(1); });
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterCallbackGenericService(&table_);
    server_ = builder.BuildAndStart();
  }
  ~Served() { server_->Shutdown(system_clock::now()); }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  /// A connection of its own.
  [[nodiscard]] std::shared_ptr<grpc::Channel> connect() const {
    grpc::ChannelArguments options;
    options.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    options.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);  // its window stays as small as it is
    return grpc::CreateCustomChannel("127.0.0.1:" + std::to_string(port_),
                                     grpc::InsecureChannelCredentials(), options);
  }

 private:
  CallLane lane_{1, 1000};
  CallTable table_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

/// A client that reads its answers when it is told to.
class Client {
 public:
  explicit Client(const Served& served) : stub_(served.connect()) {}
  ~Client() {
    calls_.clear();
    queue_.Shutdown();
    void* tag = nullptr;
    bool is_done = false;
    while (queue_.Next(&tag, &is_done)) {
    }
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void ask(const std::string& method) {
    Call& call = calls_.emplace_back();
    call.context.set_deadline(system_clock::now() + std::chrono::minutes(2));
    call.stream = stub_.PrepareCall(&call.context, method, &queue_);
    call.stream->StartCall(this);
    ASSERT_TRUE(is_done());
    call.stream->Write(bytes(1), grpc::WriteOptions().set_last_message(), this);
    ASSERT_TRUE(is_done());
  }

  /// How many answers there are to what was asked.
  [[nodiscard]] int read_all() {
    int answers = 0;
    for (Call& call : calls_) {
      grpc::ByteBuffer answer;
      call.stream->Read(&answer, this);
      static_cast<void>(is_done());
      grpc::Status status;
      call.stream->Finish(&status, this);
      static_cast<void>(is_done());
      EXPECT_TRUE(status.ok() || status.error_code() == grpc::StatusCode::CANCELLED)
          << status.error_code() << ' ' << status.error_message();
      answers += status.ok() ? 1 : 0;
    }
    calls_.clear();
    return answers;
  }

 private:
  struct Call {
    grpc::ClientContext context;
    std::unique_ptr<grpc::GenericClientAsyncReaderWriter> stream;
  };

  /// What was begun last.
  bool is_done() {
    void* tag = nullptr;
    bool is_done = false;
    return queue_.Next(&tag, &is_done) && is_done;
  }

  grpc::GenericStub stub_;
  grpc::CompletionQueue queue_;
  std::deque<Call> calls_;
};

/// How many of kCalls large answers are still there for a client that reads late. A small one to
/// another client is the last of all: it tells that the others have been given.
int kept(const UnreadBounds& bounds) {
  const Served served(bounds);
  Client late(served), other(served);
  for (int k = 0; k < kCalls; ++k) late.ask("/t/Large");
  other.ask("/t/Small");
  EXPECT_EQ(other.read_all(), 1);
  return late.read_all();
}

TEST(CallTable, AFloodOfClientsThatAreLateLosesNoAnswer) {
  EXPECT_EQ(kept({.calls = 8, .patience = hours(1), .bytes = kNoEnd}), kCalls);
}

TEST(CallTable, GivesUpTheOldestAnswersThatNobodyReadsInTime) {
  EXPECT_EQ(kept({.calls = 8, .patience = nanoseconds(0), .bytes = kNoEnd}), 7);
}

TEST(CallTable, KeepsFewAnswersHoweverLongNobodyReadsThem) {
  EXPECT_EQ(kept({.calls = 100, .patience = nanoseconds(0), .bytes = kNoEnd}), kCalls);
}

TEST(CallTable, HoldsItsMemoryHoweverYoungTheAnswersAre) {
  EXPECT_EQ(kept({.calls = 8, .patience = hours(1), .bytes = 10 * kLarge + kLarge / 2}), 10);
  // Small answers take memory, too.
  const Served served({.calls = 8, .patience = hours(1), .bytes = 1});
  Client client(served);
  client.ask("/t/Small");
  EXPECT_EQ(client.read_all(), 1);
}

}  // namespace
}  // namespace viapoint::controller
