#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace bodeflow::test {

/// A converter behind the IIO daemon's text protocol over TCP, on a port of its own on the loopback: what `iiod` is to libiio
/// 0.24. Its samples count: at index i voltage0 has the low 16 bits of i as a signed number (0.5 mV a step, 0.25 mV with a
/// `range` of 5), voltage1 the next 12
/// of them above its offset of -2048 (2 mV a step), temp0 always 25.5 degrees, timestamp i / rate in nanoseconds. They come by
/// the real clock, into as many kernel buffers as were asked for; what does not fit is dropped, and counted.
class IiodEmulator {
 public:
  struct Loss {
    std::int64_t index = 0, samples = 0;
  };
  struct Settings {
    std::vector<Loss> losses;    ///< samples that the converter leaves out
    std::int64_t pull_at = -1;   ///< the connection is cut before this index
    std::int64_t stall_at = -1;  ///< nothing comes from this index on
    std::int64_t hold_at = -1;   ///< the network is away for hold_s before this index
    double hold_s = 0.0;
    double slow_rate = 0.0;  ///< the rate that sampling_frequency gives, whatever was written; 0: as written
    bool tells_rate = true;  ///< has sampling_frequency
  };

  explicit IiodEmulator(Settings settings);
  IiodEmulator() : IiodEmulator(Settings{}) {}
  ~IiodEmulator();
  IiodEmulator(const IiodEmulator&) = delete;
  IiodEmulator& operator=(const IiodEmulator&) = delete;

  /// "ip:127.0.0.1:PORT".
  std::string uri() const;
  std::int64_t dropped() const { return dropped_; }
  /// What was written last; "device/name" or "channel/name".
  std::string attribute(const std::string& name) const;

 private:
  class Connection;

  void accept_all();
  void serve(int socket);
  std::string answer(const std::vector<std::string>& words, Connection& connection);
  std::string read_attribute(const std::vector<std::string>& words) const;
  std::string read_buffer(std::size_t bytes);
  std::size_t sample_bytes() const;
  void put_sample(std::int64_t index, std::string& to) const;
  std::string xml() const;

  Settings settings_;
  int listener_ = -1, port_ = 0;
  std::atomic<bool> stopping_{false}, pulled_{false};
  std::atomic<std::int64_t> dropped_{0};
  mutable std::mutex mutex_;
  std::map<std::string, std::string> attributes_;
  std::uint32_t mask_ = 0;
  std::size_t buffer_samples_ = 0, kernel_buffers_ = 4;
  double rate_hz_ = 0.0, started_s_ = 0.0;
  std::int64_t next_ = 0;
  std::size_t next_loss_ = 0;
  bool held_ = false;
  std::vector<int> sockets_;
  std::vector<std::thread> threads_;
};

}  // namespace bodeflow::test
