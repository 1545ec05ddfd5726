#include "controller/remote_server.hpp"

#include <grpcpp/resource_quota.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include <chrono>
#include <string>
#include <utility>

#include "viapoint/core/atomic_file.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint::controller {
namespace {

// What a stranger may take up at most. All calls are short, so few threads serve many clients.
constexpr int kMostBytes = 1 << 20;    ///< of a message
constexpr int kMostThreads = 24;       ///< calls beyond are refused (RESOURCE_EXHAUSTED)
constexpr int kMostMemory = 64 << 20;  ///< of all messages under way
constexpr int kMostStreams = 16;       ///< calls at once on one connection
constexpr int kMostMetadata = 8 << 10;
constexpr int kHandshake = 3'000;  ///< a connection has to say what it wants within it [ms]
constexpr int kIdle = 300'000;     ///< and is closed when it has asked nothing for so long [ms]
/// Asks a silent connection whether it is there, and how long the answer may take [ms].
constexpr int kProbe = 10'000, kProbeAnswer = 5'000;

std::shared_ptr<grpc::ServerCredentials> credentials_of(const Config& config) {
  if (!config.tls) return grpc::InsecureServerCredentials();
  grpc::SslServerCredentialsOptions options(
      GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  options.pem_root_certs = read_file(config.tls->authority);
  options.pem_key_cert_pairs.push_back(
      {read_file(config.tls->key), read_file(config.tls->certificate)});
  return grpc::SslServerCredentials(options);
}

}  // namespace

RemoteServer::RemoteServer(ControllerService& service, const Config& config) {
  grpc::ServerBuilder builder;
  builder.SetMaxReceiveMessageSize(kMostBytes);
  builder.SetResourceQuota(
      grpc::ResourceQuota("viapoint").SetMaxThreads(kMostThreads).Resize(kMostMemory));
  builder.SetSyncServerOption(grpc::ServerBuilder::NUM_CQS, 1);
  builder.SetSyncServerOption(grpc::ServerBuilder::MIN_POLLERS, 1);
  builder.SetSyncServerOption(grpc::ServerBuilder::MAX_POLLERS, 4);
  // A second controller on the same port has to fail, and not to share it.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMostStreams);
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, kMostMetadata);
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, kHandshake);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, kIdle);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, kProbe);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kProbeAnswer);
  const std::string address = config.host + ':' + std::to_string(config.port);
  builder.AddListeningPort(address, credentials_of(config), &port_);
  builder.RegisterService(&service);
  server_ = builder.BuildAndStart();
  if (server_ == nullptr || port_ == 0) {
    throw MotionError(ErrorCode::kBusy, "cannot listen on " + address,
                      {"end the program that listens there, or choose another port (\"listen\")",
                       "see that certificate and key of \"tls\" are PEM and belong together"});
  }
}

RemoteServer::~RemoteServer() {
  // Calls are short; one that still hangs is cut off.
  server_->Shutdown(std::chrono::system_clock::now() + std::chrono::seconds(1));
  server_->Wait();
}

}  // namespace viapoint::controller
