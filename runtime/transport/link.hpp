#pragma once

#include <bodeflow/rate.hpp>
#include <memory>
#include <span>
#include <tl/expected.hpp>

#include "transport/settings.hpp"
#include "transport/wire.hpp"

namespace bodeflow::transport {

/// A process's membership in the lab: one a process. Its destructor leaves within two seconds, whatever the library does.
class Participant;

/// Joins; cleans what crashed processes of this user left in shared memory before.
tl::expected<std::shared_ptr<Participant>, std::string> join(const Settings& settings);

/// One edge between two processes, the same on both sides.
struct Edge {
  std::string topic;
  std::uint64_t stream = 0;                            ///< what an inlet takes: other streams on the topic are refused
  std::uint32_t epoch = 0;                             ///< of the writer; a restarted writer has a higher one
  bool lossless = true;                                ///< reliable, in order, back-pressure; false: only the latest
  bool keeps_last = false;                             ///< a reader that joins late gets the last message
  double tolerance_s = 10.0;                           ///< without any progress for this long the edge fails
  std::uint64_t queue_bytes = std::uint64_t{4} << 20;  ///< what may be under way: the credit of the reader
  int readers = 1;                                     ///< that must have matched before anything is written
  bool open = false;                                   ///< shared with other DDS programs: an outlet counts any reader, an inlet
                                                       ///< begins with whatever comes first and, with stream 0, takes its stream
};

/// What is known of an edge while it runs; read by any thread.
struct EdgeState {
  bool matched = false;
  std::uint64_t messages = 0, bytes = 0;
  std::uint64_t samples = 0;       ///< of Kind::samples messages
  std::uint64_t queued_bytes = 0;  ///< outlet: sent and not yet taken; inlet: here and not yet taken
  std::uint64_t gaps = 0;          ///< messages that were lost, by their sequence
  std::uint64_t refused = 0;       ///< malformed or foreign messages: counted and dropped
  std::uint32_t reconnects = 0;
  double waited_s = 0.0;                            ///< outlet: for credit; inlet: for messages
  double stalled_s = 0.0;                           ///< since the last progress, while a call waits; 0: none waits
  double latency_p50_s = 0.0, latency_p99_s = 0.0;  ///< inlet, from the source time of the header; 0 across unsynchronised clocks
};

/// The writing end. One thread at a time; state() from any.
class Outlet {
 public:
  virtual ~Outlet() = default;
  /// Waits until the expected readers have matched.
  virtual tl::expected<void, Failure> connect(const GoOn& go_on) = 0;
  /// Sends a message of `parts` one after the other; stream, epoch, sequence and source time of the header are set here.
  /// Lossless: waits for credit. Latest: never waits.
  virtual tl::expected<void, Failure> send(Header header, std::span<const std::span<const std::byte>> parts,
                                           const GoOn& go_on) = 0;
  /// Waits until all that was sent is taken by the readers' side of the transport.
  virtual tl::expected<void, Failure> drain(const GoOn& go_on) = 0;
  virtual EdgeState state() const = 0;
};

struct Message {
  Header header;
  std::vector<std::byte> payload;
};

/// The reading end. One thread at a time; state() from any.
class Inlet {
 public:
  virtual ~Inlet() = default;
  /// The next message in order; waits for it. A gap in the sequence of a lossless edge is Failure::Kind::peer and says how many
  /// messages of which stream are missing; a writer with a higher epoch goes on from its first message (header.epoch tells).
  virtual tl::expected<Message, Failure> next(const GoOn& go_on) = 0;
  /// As next, for at most `seconds`; no message then: std::nullopt. The tolerance does not count here.
  virtual tl::expected<std::optional<Message>, Failure> poll(double seconds) = 0;
  virtual EdgeState state() const = 0;
};

tl::expected<std::unique_ptr<Outlet>, Failure> open_outlet(const std::shared_ptr<Participant>& participant, const Edge& edge);
tl::expected<std::unique_ptr<Inlet>, Failure> open_inlet(const std::shared_ptr<Participant>& participant, const Edge& edge);

/// Texts to whoever reads a topic, from anybody: requests to an agent. Reliable; at most 16 MiB each.
class Mailbox {
 public:
  virtual ~Mailbox() = default;
  /// The next text, or nothing after `seconds`.
  virtual std::optional<std::string> receive(double seconds) = 0;
};
tl::expected<std::unique_ptr<Mailbox>, Failure> open_mailbox(const std::shared_ptr<Participant>& participant,
                                                             const std::string& topic);
/// Sends one text to the mailbox of that topic; waits up to `seconds` for a reader and for its receipt.
tl::expected<void, Failure> post(const std::shared_ptr<Participant>& participant, const std::string& topic,
                                 const std::string& text, double seconds);

/// What others say of themselves on one topic: the latest text of each, and nothing of those that have gone (liveliness, 2 s).
class Board {
 public:
  virtual ~Board() = default;
  /// Replaces this process's own text.
  virtual tl::expected<void, Failure> say(const std::string& text) = 0;
  virtual std::vector<std::string> texts() = 0;
};
tl::expected<std::unique_ptr<Board>, Failure> open_board(const std::shared_ptr<Participant>& participant,
                                                         const std::string& topic, bool writes);

}  // namespace bodeflow::transport
