#pragma once

#include <sys/types.h>

#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace bodeflow::lab {

/// The process that runs the launcher's own part.
class OwnPart {
 public:
  OwnPart() = default;
  ~OwnPart() { end(); }
  OwnPart(const OwnPart&) = delete;
  OwnPart& operator=(const OwnPart&) = delete;

  /// Error: why it could not be started.
  tl::expected<void, std::string> start(const std::vector<std::string>& command, const std::vector<std::string>& options);
  bool runs();
  /// How it ended; empty while it runs.
  const std::string& end_text() const { return end_text_; }
  /// Waits two seconds for its end, then ends it.
  void end();

 private:
  pid_t pid_ = 0;
  std::string end_text_;
};

}  // namespace bodeflow::lab
