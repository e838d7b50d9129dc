#pragma once

#include <bodeflow/transport.h>

#include <bodeflow/block.hpp>
#include <complex>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace bodeflow {
inline namespace v0 {

namespace detail {
struct HostAccess {};
}  // namespace detail

/// What a block reaches its host by.
template <>
struct Border<detail::HostAccess> {
  static const bf_host& host(const Block& block) { return block.services_.host(); }
};

/// A topic and how it is used.
struct Topic {
  std::string name;
  std::uint32_t domain = 0;
  std::uint32_t readers = 1;  ///< a writer waits for so many
  bool latest = false;        ///< the newest message instead of each
  bool keeps_last = false;    ///< a reader that comes late gets the last message
  double tolerance_s = 5.0;
  std::uint64_t queue_bytes = std::uint64_t{4} << 20;
};

/// Topics of the network, for a block. Open them in `activate`, close them in `deactivate`. Each function throws when it fails;
/// the host has told why.
class Transport {
 public:
  /// Fails where the host has no transport.
  explicit Transport(const Block& block)
      : host_(&Border<detail::HostAccess>::host(block)),
        c_(static_cast<const bf_transport*>(host_->extension(host_, BF_EXTENSION_TRANSPORT))) {
    if (c_ == nullptr) fail("this host has no transport: bodeflow was built without Fast DDS, or only checks the graph");
  }

  class Writer {
   public:
    void write(const bf_topic_message& message) const { require(c_->write(host_, end_.get(), &message)); }
    /// Waits until everything has reached the readers.
    void flush() const { require(c_->flush(host_, end_.get())); }

   private:
    friend class Transport;
    static void require(std::int32_t code) {
      if (code != BF_OK) throw Services::HostRefused();
    }
    const bf_host* host_ = nullptr;
    const bf_transport* c_ = nullptr;
    std::shared_ptr<void> end_;
  };

  class Reader {
   public:
    /// The next message; it lives until the next call. kind is BF_MESSAGE_NONE where none came within `seconds`; less than 0:
    /// waits for the tolerance, then fails.
    bf_topic_message read(double seconds = -1.0) const {
      bf_topic_message message{};
      message.struct_size = sizeof message;
      if (c_->read(host_, end_.get(), seconds, &message) != BF_OK) throw Services::HostRefused();
      return message;
    }

   private:
    friend class Transport;
    const bf_host* host_ = nullptr;
    const bf_transport* c_ = nullptr;
    std::shared_ptr<void> end_;
  };

  Writer writer(const Topic& topic) const {
    const bf_topic c = c_topic(topic);
    Writer made;
    made.host_ = host_;
    made.c_ = c_;
    made.end_ = owned(c_->open_writer(c_, host_, &c), c_->close_writer);
    return made;
  }
  Reader reader(const Topic& topic) const {
    const bf_topic c = c_topic(topic);
    Reader made;
    made.host_ = host_;
    made.c_ = c_;
    made.end_ = owned(c_->open_reader(c_, host_, &c), c_->close_reader);
    return made;
  }

 private:
  static bf_topic c_topic(const Topic& topic) {
    bf_topic c{};
    c.struct_size = sizeof c;
    if (topic.latest) c.flags |= BF_TOPIC_LATEST;
    if (topic.keeps_last) c.flags |= BF_TOPIC_KEEPS_LAST;
    c.name = topic.name.c_str();
    c.domain = topic.domain;
    c.readers = topic.readers;
    c.tolerance_s = topic.tolerance_s;
    c.queue_bytes = topic.queue_bytes;
    return c;
  }
  static std::shared_ptr<void> owned(void* end, void (*close)(void*)) {
    if (end == nullptr) throw Services::HostRefused();
    return {end, close};
  }

  const bf_host* host_;
  const bf_transport* c_;
};

}  // namespace v0
}  // namespace bodeflow
