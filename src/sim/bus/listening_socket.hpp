#pragma once
// The socket to which clients of the simulator connect.

#include "blactl/base/error.hpp"

#include <filesystem>
#include <memory>

namespace blactl::sim {

/// A listening SOCK_SEQPACKET socket. A lock file beside it, `<socket>.lock`, distinguishes a
/// running simulator from one that was killed: the kernel releases the lock with the process.
class ListeningSocket {
 public:
  /// Creates the folder (0700) and replaces the socket of a dead simulator. Errors: busy (another
  /// one is running), interface.
  [[nodiscard]] static Result<std::unique_ptr<ListeningSocket>>
  open(const std::filesystem::path& path);
  ~ListeningSocket();
  ListeningSocket(const ListeningSocket&) = delete;
  ListeningSocket& operator=(const ListeningSocket&) = delete;

  [[nodiscard]] int descriptor() const { return socket_; }

 private:
  explicit ListeningSocket(std::filesystem::path path) : path_(std::move(path)) {}

  [[nodiscard]] Result<void> prepare_folder();
  [[nodiscard]] Result<void> lock();
  [[nodiscard]] Result<void> listen();
  [[nodiscard]] std::unexpected<Error> failure(int error) const;

  std::filesystem::path path_;
  int lock_ = -1;
  int socket_ = -1;
  bool bound_ = false;
};

} // namespace blactl::sim
