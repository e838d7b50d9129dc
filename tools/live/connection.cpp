#include "live/connection.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace bodeflow::tools::live {
namespace {

using Clock = std::chrono::steady_clock;

/// How soon `closing` is seen.
constexpr auto kSlice = std::chrono::milliseconds(50);
/// What the other end gets to read the answer to a request of which not all was read.
constexpr auto kLinger = std::chrono::milliseconds(200);

}  // namespace

Connection::Connection(int socket, std::size_t most_read, double most_time_s, const std::atomic<bool>& closing)
    : socket_(socket),
      left_(most_read),
      until_(Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(most_time_s))),
      closing_(closing) {
  fcntl(socket, F_SETFD, FD_CLOEXEC);
  fcntl(socket, F_SETFL, fcntl(socket, F_GETFL) | O_NONBLOCK);
}

Connection::~Connection() {
  shutdown(socket_, SHUT_WR);
  until_ = std::min(until_, Clock::now() + kLinger);
  char rest[4096];
  while (wait(POLLIN) && recv(socket_, rest, sizeof rest, 0) > 0) {
  }
  close(socket_);
}

bool Connection::wait(short events) const {
  while (!closing_.load(std::memory_order_relaxed)) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until_ - Clock::now());
    if (left.count() <= 0) return false;
    pollfd one{socket_, events, 0};
    const int ready = poll(&one, 1, static_cast<int>(std::min(left, kSlice).count()));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
  return false;
}

bool Connection::readable() const { return left_ > 0 && wait(POLLIN); }

long Connection::read(char* to, std::size_t size) {
  while (readable()) {
    const ssize_t got = recv(socket_, to, std::min(size, left_), 0);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (got > 0) left_ -= static_cast<std::size_t>(got);
    return got;
  }
  return -1;
}

long Connection::write(const char* from, std::size_t size) {
  while (wait(POLLOUT)) {
    const ssize_t sent = send(socket_, from, size, MSG_NOSIGNAL);
    if (sent < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    return sent;
  }
  return -1;
}

}  // namespace bodeflow::tools::live
