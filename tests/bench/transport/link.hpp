#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

/// One way between two processes, as both contestants offer it.
class Sender {
 public:
  virtual ~Sender() = default;
  virtual void connect() = 0;
  virtual void send(std::span<const std::byte> bytes) = 0;
  virtual void drain() = 0;
};

class Receiver {
 public:
  virtual ~Receiver() = default;
  /// Waits for the next message; its size in bytes.
  virtual std::size_t next() = 0;
};

struct Way {
  std::string carrier;  ///< shm or udp
  unsigned datagram = 1400;
  unsigned domain = 0;
};

/// bodeflow's transport.
std::unique_ptr<Sender> our_sender(const Way& way, const std::string& topic);
std::unique_ptr<Receiver> our_receiver(const Way& way, const std::string& topic);
/// Fast DDS alone, with the same transports, QoS and timings.
std::unique_ptr<Sender> bare_sender(const Way& way, const std::string& topic);
std::unique_ptr<Receiver> bare_receiver(const Way& way, const std::string& topic);
