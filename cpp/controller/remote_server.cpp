#include "controller/remote_server.hpp"

#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <utility>

#include "viapoint/core/atomic_file.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint::controller {
namespace {

// What a stranger may take up at most. All calls are short, so few threads serve many clients.
constexpr int kMostBytes = 1 << 20;    ///< of a message
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

/// An IPv6 address without its brackets.
std::string bare(const std::string& host) {
  return host.front() == '[' ? host.substr(1, host.size() - 2) : host;
}

/// In the older HTTP, so that clients wait before they come again: after HTTP/2's own goodbye they
/// come at once, and by the thousand.
constexpr const char* kFarewell =
    "HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\nContent-Type: text/plain\r\n\r\n"
    "The controller has too many connections.\n";

/// A server whose clients come from elsewhere never looks at its certificates until one comes. One
/// that listens does: here for an instant, to nobody, where no network leads.
void require_certificates(const Config& config) {
  grpc::CallbackGenericService no_calls;
  grpc::ServerBuilder builder;
  int port = 0;
  builder.AddListeningPort("unix-abstract:viapoint-" + std::to_string(getpid()),
                           credentials_of(config), &port);
  builder.RegisterCallbackGenericService(&no_calls);
  if (builder.BuildAndStart() != nullptr && port != 0) return;
  throw MotionError(
      ErrorCode::kFile, "the files of \"tls\" make no server",
      {"see that all three are PEM", "see that certificate and key of \"tls\" belong together"});
}

}  // namespace

RemoteServer::RemoteServer(ControllerService& service, const Config& config) {
  if (config.tls) require_certificates(config);
  grpc::ServerBuilder builder;
  builder.SetMaxReceiveMessageSize(kMostBytes);
  builder.SetResourceQuota(grpc::ResourceQuota("viapoint").Resize(kMostMemory));
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMostStreams);
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, kMostMetadata);
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, kHandshake);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, kIdle);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, kProbe);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kProbeAnswer);
  using From = grpc::ServerBuilder::experimental_type::ExternalConnectionType;
  acceptor_ =
      builder.experimental().AddExternalConnectionAcceptor(From::FROM_FD, credentials_of(config));
  builder.RegisterCallbackGenericService(&service.calls());
  server_ = builder.BuildAndStart();
  if (server_ == nullptr) {
    throw MotionError(ErrorCode::kBusy, "the server for clients cannot be started");
  }
  gate_ = std::make_unique<ConnectionGate>(
      bare(config.host), config.port, config.tls ? "" : kFarewell, [this](int socket) {
        grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters client;
        client.fd = socket;
        acceptor_->HandleNewConnection(&client);
      });
}

RemoteServer::~RemoteServer() {
  gate_.reset();
  // Calls are short; one that still hangs is cut off.
  server_->Shutdown(std::chrono::system_clock::now() + std::chrono::seconds(1));
  server_->Wait();
}

}  // namespace viapoint::controller
