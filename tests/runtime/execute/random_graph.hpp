#pragma once

#include <random>

#include "bench.hpp"

namespace bodeflow::test {

/// A graph without plan or purpose: rates from 250 Hz to 4 kHz, delays, loops, records with latencies, asynchronous blocks,
/// sources that end early.
class RandomGraph {
 public:
  /// `stated`: sources tell when they will end.
  explicit RandomGraph(std::uint32_t seed, bool stated = false) : stated_(stated), random_(seed) {
    bench.add("noise", "streams.noise");
    streams_ = {{"noise", 0}};
    bench.add("pulse", "messages.pulse", {{"rate", 1000.0}, {"every", std::int64_t{37}}});
    streams_.push_back({"pulse", 0});
    messages_ = {"pulse"};
    const int blocks = 6 + below(10);
    for (int i = 0; i < blocks; ++i) add("b" + std::to_string(i));
    bench.duration(0.3 + 0.01 * below(40));
  }

  Bench bench;

 private:
  struct Stream {
    std::string name;
    int octaves;  ///< of two around 1 kHz
  };

  int below(int n) { return static_cast<int>(random_() % static_cast<std::uint32_t>(n)); }
  const Stream& any() { return streams_[static_cast<std::size_t>(below(static_cast<int>(streams_.size())))]; }

  void add(const std::string& name) {
    const Stream from = any();
    switch (below(8)) {
      case 0:
        return add_source(name);
      case 1:
        return add_pole(name, from);
      case 2:
        return add_sum(name, from);
      case 3:
        return add_rate(name, from);
      case 4:
        return add_loop(name, from);
      case 5:
        return add_latch(name, from);
      case 6:
        return add_frame(name, from);
      default:
        return add_relay(name);
    }
  }

  void add_source(const std::string& name) {
    bench.add(name, "streams.counter", {{"ends", std::int64_t{below(600)}}, {"stated", below(2) == 0 || stated_}});
    streams_.push_back({name, 0});
  }

  void add_pole(const std::string& name, const Stream& from) {
    const std::int64_t delay = below(3) == 0 ? below(90) : below(3);
    std::vector<double> initial;
    for (std::int64_t i = 0; i < delay; ++i) initial.push_back(0.25 * below(5));
    bench.add(name, "streams.pole", {{"pole", 0.5}, {"delay", delay}, {"initial", initial}});
    bench.connect(from.name, name);
    streams_.push_back({name, from.octaves});
  }

  void add_sum(const std::string& name, const Stream& from) {
    bench.add(name, "streams.sum", {{"sign", 0.5}});
    bench.connect(from.name, name + ".in");
    for (const Stream& other : streams_)
      if (other.octaves == from.octaves && other.name != from.name) {
        bench.connect(other.name, name + ".feedback");
        break;
      }
    streams_.push_back({name, from.octaves});
  }

  void add_rate(const std::string& name, const Stream& from) {
    const int step = from.octaves > 0 ? -2 : from.octaves < 0 ? 2 : below(2) == 0 ? -2 : 2;
    bench.add(name, step > 0 ? "streams.hold" : "streams.decimate", {{"factor", std::int64_t{4}}});
    bench.connect(from.name, name);
    streams_.push_back({name, from.octaves + step});
  }

  void add_loop(const std::string& name, const Stream& from) {
    bench.add(name, "streams.sum");
    bench.add(name + "p", "streams.pole", {{"pole", 0.3}, {"delay", std::int64_t{1 + below(6)}}});
    bench.connect(from.name, name + ".in");
    bench.connect(name, name + "p");
    bench.connect(name + "p", name + ".feedback");
    streams_.push_back({name, from.octaves});
    streams_.push_back({name + "p", from.octaves});
  }

  graph::Latency latency() { return below(2) == 0 ? after(0, 1) : after(below(40), 1 + below(700)); }
  const std::string& any_message() { return messages_[static_cast<std::size_t>(below(static_cast<int>(messages_.size())))]; }

  void add_latch(const std::string& name, const Stream& from) {
    bench.add(name, "messages.latch");
    bench.connect(from.name, name);
    bench.tell(any_message(), name + ".first", latency());
    bench.tell(any_message(), name + ".second", latency());
    bench.schedule(0.001 * below(400), name, "scale", 2.0);
    streams_.push_back({name, from.octaves});
  }

  void add_frame(const std::string& name, const Stream& from) {
    bench.add(name, "messages.frame", {{"length", std::int64_t{below(2) == 0 ? 8 : 20}}, {"closing", below(2) == 0}});
    bench.connect(from.name, name);
    messages_.push_back(name);
  }

  void add_relay(const std::string& name) {
    bench.add(name, below(2) == 0 ? "messages.relay" : "messages.slow_relay");
    bench.tell(any_message(), name, latency());
    bench.tell(any_message(), name, latency());
    messages_.push_back(name);
  }

  bool stated_;
  std::mt19937 random_;
  std::vector<Stream> streams_;
  std::vector<std::string> messages_;
};

}  // namespace bodeflow::test
