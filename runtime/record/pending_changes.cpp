#include "record/pending_changes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "record/files.hpp"

namespace bodeflow::record {
namespace {

/// The file holds the mark, then address, size and bytes of each change; numbers have 64 bits, in the machine's order.
constexpr char kMark[8] = {'B', 'F', 'P', 'E', 'N', 'D', '1', '\n'};
constexpr std::chrono::milliseconds kWriterTime{2000};

std::filesystem::path pending_of(std::filesystem::path path) { return path += ".pending"; }

void put_number(std::vector<unsigned char>& to, std::uint64_t number) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(&number);
  to.insert(to.end(), bytes, bytes + sizeof number);
}

std::vector<unsigned char> packed(const std::vector<PendingChange>& changes) {
  std::vector<unsigned char> all(std::begin(kMark), std::end(kMark));
  for (const auto& change : changes) {
    put_number(all, change.address);
    put_number(all, change.bytes.size());
    all.insert(all.end(), change.bytes.begin(), change.bytes.end());
  }
  return all;
}

/// Throws std::runtime_error where the text is no whole list of changes of a file of `held` bytes.
std::vector<PendingChange> unpacked(const std::string& text, std::uint64_t held) {
  std::size_t at = 0;
  const auto take = [&](void* to, std::uint64_t size) {
    if (size > text.size() - at) throw std::runtime_error("it ends in the middle of a change");
    std::memcpy(to, text.data() + at, size);
    at += size;
  };
  char mark[sizeof kMark];
  take(mark, sizeof mark);
  if (std::memcmp(mark, kMark, sizeof mark) != 0) throw std::runtime_error("it doesn't begin as such a file does");
  std::vector<PendingChange> changes;
  while (at < text.size()) {
    std::uint64_t address = 0, size = 0;
    take(&address, sizeof address);
    take(&size, sizeof size);
    if (address > held || size > held - address || size > text.size() - at)
      throw std::runtime_error(fmt::format("it changes {} bytes at {} of a file of {}", size, address, held));
    PendingChange change{address, std::vector<unsigned char>(size)};
    take(change.bytes.data(), size);
    changes.push_back(std::move(change));
  }
  return changes;
}

bool write_each(int file, const std::vector<PendingChange>& changes) {
  return std::all_of(changes.begin(), changes.end(), [&](const PendingChange& change) {
    return write_at(file, change.address, change.bytes.data(), change.bytes.size());
  });
}

struct Descriptor {
  int number;
  explicit Descriptor(int n) : number(n) {}
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
};

/// Makes the file of pending changes, locked as long as its descriptor is open. False: it could not be made.
bool make_pending(const std::filesystem::path& pending, const Descriptor& file, const std::vector<unsigned char>& content,
                  const std::filesystem::path& unfinished) {
  return file.number >= 0 && ::flock(file.number, LOCK_EX | LOCK_NB) == 0 &&
         write_at(file.number, 0, content.data(), content.size()) && std::rename(unfinished.c_str(), pending.c_str()) == 0;
}

/// Locks the file of pending changes, which only its living writer holds for a moment. False: the file has gone.
bool lock_when_left(const Descriptor& pending) {
  const auto until = std::chrono::steady_clock::now() + kWriterTime;
  while (::flock(pending.number, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK && errno != EINTR) throw std::runtime_error(std::strerror(errno));
    if (std::chrono::steady_clock::now() >= until) throw std::runtime_error("another process holds it");
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  struct stat now {};
  return ::fstat(pending.number, &now) == 0 && now.st_nlink > 0;
}

void apply_left(const std::filesystem::path& path, const std::filesystem::path& pending) {
  const Descriptor left(::open(pending.c_str(), O_RDONLY | O_CLOEXEC));
  if (left.number < 0 && errno == ENOENT) return;
  if (left.number < 0) throw std::runtime_error(std::strerror(errno));
  if (!lock_when_left(left)) return;
  const Descriptor file(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  struct stat now {};
  if (file.number < 0 || ::fstat(file.number, &now) != 0) throw std::runtime_error(std::strerror(errno));
  const auto text = read_text(pending);
  if (!text) throw std::runtime_error(text.error());
  if (!write_each(file.number, unpacked(*text, static_cast<std::uint64_t>(now.st_size))))
    throw std::runtime_error(std::strerror(errno));
  ::unlink(pending.c_str());
}

}  // namespace

bool write_at(int file, std::uint64_t address, const unsigned char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t done = ::pwrite(file, bytes, size, static_cast<off_t>(address));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes += done;
    address += static_cast<std::uint64_t>(done);
    size -= static_cast<std::size_t>(done);
  }
  return true;
}

bool write_changes(const std::filesystem::path& path, int file, const std::vector<PendingChange>& changes) {
  if (changes.empty()) return true;
  const std::filesystem::path pending = pending_of(path);
  std::filesystem::path unfinished = pending;
  unfinished += ".new";
  const Descriptor copy(::open(unfinished.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  const bool made = make_pending(pending, copy, packed(changes), unfinished);
  const bool written = write_each(file, changes);
  if (!made) ::unlink(unfinished.c_str());
  if (made && written) ::unlink(pending.c_str());
  return written;
}

void finish_changes(const std::filesystem::path& path) {
  const std::filesystem::path pending = pending_of(path);
  try {
    apply_left(path, pending);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(
        fmt::format("its writer was killed while it changed it, and the changes that '{}' holds can't be finished: {}",
                    pending.string(), error.what()));
  }
}

}  // namespace bodeflow::record
