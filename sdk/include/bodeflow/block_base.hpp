#pragma once

#include <bodeflow/facts.hpp>
#include <bodeflow/io.hpp>
#include <bodeflow/parameters.hpp>
#include <bodeflow/services.hpp>
#include <cstdint>
#include <optional>
#include <string>

namespace bodeflow {
inline namespace v0 {

class Parts;

/// What `activate` is told.
struct Activation {
  std::uint64_t max_count = 0;  ///< most firings in one process call
  std::uint64_t seed = 0;       ///< of this block, derived from the run's seed and the block's name
  Rate rate;                    ///< firings per second; zero for a block without streams
  bool realtime = false;        ///< the clock does not wait
  int vector_level = 1;         ///< widest vector unit that kernels may use: 1 SSE2, 3 AVX2, 4 AVX-512
};

/// Takes what a block has to say before a run, see Block::advise.
class Advice {
 public:
  using Tell = void (*)(void* context, std::int32_t level, const char* text);
  Advice(Tell sink, void* context) : tell_(sink), context_(context) {}

  /// Something worth knowing: `bodeflow check` prints it.
  void tell(const std::string& text) { tell_(context_, BF_LOG_INFO, text.c_str()); }
  /// Something that will spoil the result, and what to do about it: printed before a run as well.
  void warn(const std::string& text) { tell_(context_, BF_LOG_WARNING, text.c_str()); }

 private:
  Tell tell_;
  void* context_;
};

/// One unit of work. A class that derives from it has `static void describe(Describe&)` and a default constructor; all else
/// is overridden where needed. Each function may throw, `fail("reason")` above all: the run ends with the block's name and
/// that text.
class Block {
 public:
  Block() = default;
  virtual ~Block() = default;
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;

  /// Takes the parameters. Called once, before all others.
  virtual void configure(const Parameters&) {}
  /// States the facts of the outputs from those of the inputs. Pure: called any number of times, the same answer each time.
  virtual void resolve(Facts&) {}
  /// Says what the author of a graph should know before it runs. The facts of all streams are final; lengths are what will
  /// really arrive. Called any number of times, changes nothing.
  virtual void advise(const Facts&, Advice&) {}
  /// Allocates and opens all that `process` needs.
  virtual void activate(const Activation&) {}
  /// Moves samples.
  virtual void process(Io&) {}
  /// Takes a record that takes effect before the first sample of the coming `process`.
  virtual void receive(int /*message_port*/, const RecordView&, Io&) {}
  /// A live parameter changed; all current values.
  virtual void change(const Parameters&) {}
  /// After the last sample: last records may be sent.
  virtual void finish(Io&) {}
  /// Back to the state after `activate`. If live parameters changed since, `change` was called with the old values before.
  virtual void reset() {}
  /// Closes files, gives memory back.
  virtual void deactivate() {}

 protected:
  void log_info(const std::string& text) const { services_.log(BF_LOG_INFO, text); }
  void log_warning(const std::string& text) const { services_.log(BF_LOG_WARNING, text); }
  /// Puts an input file's checksum into the manifest.
  void note_input(const std::string& path) const { services_.note_input(path); }
  /// The absolute path of a file that this block may write, inside the run directory; nothing while a graph is only checked.
  std::optional<std::string> output_path(const std::string& name) const { return services_.output_path(name); }
  /// The effects and base models of all plugins; include <bodeflow/parts.hpp>.
  Parts parts() const;

 private:
  template <class B>
  friend struct Border;
  Services services_;
};

}  // namespace v0
}  // namespace bodeflow
