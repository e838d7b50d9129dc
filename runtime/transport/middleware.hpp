#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "transport/settings.hpp"

/// What the transport needs of a DDS library, without its headers: bytes go in and come out, readers and writers find each other.
namespace bodeflow::transport::middleware {

using Guid = std::array<std::uint8_t, 16>;

/// Both run on the same host: the first four bytes of their identifiers, the library's mark and a hash of the interfaces, agree.
inline bool same_host(const Guid& a, const Guid& b) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && a[3] == b[3]; }

enum class Type { message, credit };  ///< structs of bodeflow.idl

/// Which messages a topic must bring.
enum class Flow {
  all,     ///< reliable, each one, to readers that have matched
  latest,  ///< best effort, the newest
  last,    ///< reliable, the newest of each writer, also to readers that match later
  present  ///< as last, and a reader learns within two seconds that a writer is no longer there
};

struct Topic {
  std::string name;
  Type type = Type::message;
  Flow flow = Flow::all;
};

/// Told by threads of the library: must not wait and must not call back into it.
class WriterSink {
 public:
  virtual ~WriterSink() = default;
  virtual void matched(const Guid& reader, bool yes) = 0;
};

class ReaderSink {
 public:
  virtual ~ReaderSink() = default;
  /// False: samples stay with the library, until Reader::pull.
  virtual bool room() = 0;
  /// One sample; the bytes live during the call. Calls never overlap.
  virtual void sample(std::span<const std::byte> bytes) = 0;
  /// After sample: whose it was.
  virtual void from(const Guid& writer) { static_cast<void>(writer); }
  /// A writer has matched and is alive, or no longer.
  virtual void matched(const Guid& writer, bool yes) = 0;
};

class Writer {
 public:
  virtual ~Writer() = default;
  virtual Guid guid() const = 0;
  /// One sample of `parts` one after the other; waits at most 50 ms for room. False: nothing was sent, try again.
  virtual bool write(std::span<const std::span<const std::byte>> parts) = 0;
  /// All that was written has reached the readers that are matched; waits at most `seconds`.
  virtual bool acknowledged(double seconds) = 0;
};

class Reader {
 public:
  virtual ~Reader() = default;
  virtual Guid guid() const = 0;
  /// Hands over what was left for want of room.
  virtual void pull() = 0;
};

/// One membership in the library's network. Writers and readers keep it alive. All destructors return within two seconds.
class Node {
 public:
  virtual ~Node() = default;
  virtual tl::expected<std::unique_ptr<Writer>, Failure> writer(const Topic& topic, std::weak_ptr<WriterSink> sink) = 0;
  virtual tl::expected<std::unique_ptr<Reader>, Failure> reader(const Topic& topic, std::weak_ptr<ReaderSink> sink) = 0;
};

/// Joins over one carrier (automatic is refused here).
tl::expected<std::shared_ptr<Node>, std::string> join(const Settings& settings, Settings::Carrier carrier);

}  // namespace bodeflow::transport::middleware
