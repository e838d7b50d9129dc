// Blocks for the benchmarks alone: an endless source, a sink, a copy, a heavy block, and both ends of a latency measurement.

#include <bodeflow/block.hpp>
#include <chrono>
#include <cmath>
#include <cstring>

namespace {

using bodeflow::Describe;
using bodeflow::Facts;
using bodeflow::In;
using bodeflow::Io;
using bodeflow::Out;
using bodeflow::Parameters;

/// Zeros, as GNU Radio's null source gives.
class Source final : public bodeflow::Block {
 public:
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d) {
    d.id("bench.source").summary("Gives zeros.").realtime_safe();
    d.stream_out(out);
  }
  void resolve(Facts& f) override {
    auto& facts = f.out(out);
    facts.known = true;
    facts.element = BF_F64;
    facts.channels = 1;
    facts.rate = bodeflow::Rate(1'000'000, 1);
  }
  void process(Io& io) override {
    auto y = io.write(out, 0);
    std::memset(y.data(), 0, y.size_bytes());
  }
};

class Sink final : public bodeflow::Block {
 public:
  static constexpr In<double> in{0, "in"};

  static void describe(Describe& d) {
    d.id("bench.sink").summary("Takes samples and does nothing.").realtime_safe();
    d.stream_in(in);
  }
  void process(Io&) override {}
};

class Copy final : public bodeflow::Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d) {
    d.id("bench.copy").summary("Copies samples.").realtime_safe();
    d.stream_in(in);
    d.stream_out(out).same_as(in);
  }
  void process(Io& io) override {
    auto x = io.read(in, 0);
    auto y = io.write(out, 0);
    std::memcpy(y.data(), x.data(), x.size_bytes());
  }
};

/// Much work on every sample: what a second thread is for.
class Heavy final : public bodeflow::Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d) {
    d.id("bench.heavy").summary("Thirty sines of every sample.").realtime_safe().cost_ns(400);
    d.stream_in(in);
    d.stream_out(out).same_as(in);
  }
  void process(Io& io) override {
    auto x = io.read(in, 0);
    auto y = io.write(out, 0);
    for (std::size_t n = 0; n < x.size(); ++n) {
      double value = x[n];
      for (int i = 0; i < 30; ++i) value = std::sin(value + 0.1);
      y[n] = value;
    }
  }
};

double now_ns() {
  return static_cast<double>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count());
}

/// One sample that carries the time at which it left.
class Stamp final : public bodeflow::Block {
 public:
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d) {
    d.id("bench.stamp").summary("Gives the time in nanoseconds.").realtime_safe();
    d.stream_out(out);
  }
  void resolve(Facts& f) override {
    auto& facts = f.out(out);
    facts.known = true;
    facts.element = BF_F64;
    facts.channels = 1;
    facts.rate = bodeflow::Rate(1'000'000, 1);
  }
  void process(Io& io) override {
    for (double& y : io.write(out, 0)) y = now_ns();
  }
};

/// The age of each sample, into a table that the benchmark reads through a record at the end.
class Age final : public bodeflow::Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr bodeflow::MessageOut out{0, "out"};

  static void describe(Describe& d) {
    d.id("bench.age").summary("Keeps the age of every sample.");
    d.stream_in(in);
    d.message_out(out).record_type("ages");
    d.parameter("samples", std::int64_t{100000}).range(1, 1e7);
  }
  void configure(const Parameters& p) override { ages_.reserve(static_cast<std::size_t>(p.integer("samples"))); }
  void process(Io& io) override {
    for (const double left : io.read(in, 0))
      if (ages_.size() < ages_.capacity()) ages_.push_back(now_ns() - left);
  }
  void finish(Io& io) override {
    bodeflow::RecordBuilder record("ages");
    auto out_ages = record.array<double>("age", "ns", {ages_.size()});
    std::copy(ages_.begin(), ages_.end(), out_ages.begin());
    io.emit(out, record);
  }
  void reset() override { ages_.clear(); }

 private:
  std::vector<double> ages_;
};

}  // namespace

BODEFLOW_PLUGIN("bench", "1.0.0", Source, Sink, Copy, Heavy, Stamp, Age)
