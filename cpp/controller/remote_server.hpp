/// @file
#pragma once

#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

#include <memory>

#include "controller/config.hpp"
#include "controller/connection_gate.hpp"
#include "controller/controller_service.hpp"

namespace viapoint::controller {

/// Listens for clients, in threads of ordinary priority. Destruction ends all calls.
class RemoteServer {
 public:
  /// @param service outlives the server
  /// @throws MotionError(kFile) for TLS files that cannot be read; kBusy where the address
  ///   cannot be listened on
  RemoteServer(ControllerService& service, const Config& config);
  ~RemoteServer();
  RemoteServer(const RemoteServer&) = delete;
  RemoteServer& operator=(const RemoteServer&) = delete;

  /// The port listened on, also where port 0 left the choice to the system.
  [[nodiscard]] int port() const { return gate_->port(); }

 private:
  std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> acceptor_;
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<ConnectionGate> gate_;
};

}  // namespace viapoint::controller
