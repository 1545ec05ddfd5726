/// @file
#pragma once

#include <grpcpp/server.h>

#include <memory>

#include "controller/config.hpp"
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
  [[nodiscard]] int port() const { return port_; }

 private:
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace viapoint::controller
