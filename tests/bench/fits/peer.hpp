#pragma once

#include <sys/types.h>

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace bench {

/// One call of a peer.
struct Call {
  double cpu_s = 0.0;
  double rms = 0.0;
  int unstable = 0;  ///< poles; -1: it gave no model
  int tunings = 1;   ///< how many it can be called with
};

/// A process that fits: a command in, a line of figures out. Nothing where it can't be started or a package is absent.
class Peer {
 public:
  explicit Peer(const std::vector<std::string>& command);
  ~Peer();
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// What it says of itself; empty: it is absent.
  const std::string& banner() const { return banner_; }
  std::optional<Call> call(const std::string& command);

 private:
  std::string line();

  pid_t child_ = 0;
  std::FILE* commands_ = nullptr;
  std::FILE* answers_ = nullptr;
  std::string banner_;
};

}  // namespace bench
