#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>

namespace bodeflow::tools::live {

/// A socket from which and to which data goes within a time and a size; owned. What does not fit is as if the other end had gone.
class Connection {
 public:
  /// `closing`, set by another thread, ends every wait soon.
  Connection(int socket, std::size_t most_read, double most_time_s, const std::atomic<bool>& closing);
  /// Lets the other end read what was sent, then closes.
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  int socket() const { return socket_; }
  /// Bytes, at least one; 0 or less: over.
  long read(char* to, std::size_t size);
  long write(const char* from, std::size_t size);
  bool readable() const;

 private:
  bool wait(short events) const;

  int socket_;
  std::size_t left_;
  std::chrono::steady_clock::time_point until_;
  const std::atomic<bool>& closing_;
};

}  // namespace bodeflow::tools::live
