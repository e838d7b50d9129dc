#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "trust/openssl.hpp"

namespace bodeflow::trust {

inline constexpr mode_t kPublic = 0644, kPrivate = 0600;

/// The whole content. Error: with the path.
Expected<std::string> read_file(const std::filesystem::path& path);
/// Writes a file that does not exist yet, and waits for the disk. Error: with the path, also where it exists.
Expected<void> write_new(const std::filesystem::path& path, const std::string& text, mode_t mode);
/// Replaces a file: readers see the old content or the new one.
Expected<void> replace(const std::filesystem::path& path, const std::string& text, mode_t mode);

/// A new folder beside `target`, readable by its owner only, which becomes it or goes away.
class Staging {
 public:
  static Expected<Staging> beside(const std::filesystem::path& target);
  Staging(Staging&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  Staging& operator=(Staging&&) = delete;
  ~Staging();
  const std::filesystem::path& path() const { return path_; }
  /// Gives the folder its name, which must be free or an empty folder's.
  Expected<void> becomes(const std::filesystem::path& target);

 private:
  explicit Staging(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

/// Keeps other processes from changing the folder while it lives.
class Lock {
 public:
  static Expected<Lock> of(const std::filesystem::path& folder);
  Lock(Lock&& other) noexcept : folder_(std::exchange(other.folder_, -1)) {}
  Lock& operator=(Lock&&) = delete;
  ~Lock();

 private:
  explicit Lock(int folder) : folder_(folder) {}
  int folder_ = -1;
};

/// A file or, where the name ends in '/', a folder of an archive.
struct Archived {
  std::string name;  ///< at most 99 bytes
  std::string content;
  mode_t mode = kPublic;
};

/// A tar archive (POSIX 1003.1, ustar) that belongs to whoever unpacks it.
std::string tar(const std::vector<Archived>& files, long modified_s);

}  // namespace bodeflow::trust
