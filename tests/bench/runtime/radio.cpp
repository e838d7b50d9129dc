#include "radio.hpp"

#include <gnuradio/blocks/copy.h>
#include <gnuradio/blocks/head.h>
#include <gnuradio/blocks/multiply_const.h>
#include <gnuradio/blocks/null_sink.h>
#include <gnuradio/blocks/null_source.h>
#include <gnuradio/io_signature.h>
#include <gnuradio/sync_block.h>
#include <gnuradio/top_block.h>

#include <atomic>

#include "measure.hpp"

namespace bench {
namespace {

constexpr int kLowLatencyItems = 256;

/// What source and sink share: one sample is on its way at a time.
struct Flight {
  std::atomic<std::size_t> landed{0};
  std::atomic<double> left{0.0};
  std::vector<double> ages;
};

class OneByOne final : public gr::sync_block {
 public:
  OneByOne(Flight& flight, std::size_t samples)
      : gr::sync_block("one_by_one", gr::io_signature::make(0, 0, 0), gr::io_signature::make(1, 1, sizeof(float))),
        flight_(flight),
        samples_(samples) {}

  int work(int, gr_vector_const_void_star&, gr_vector_void_star& outputs) override {
    if (sent_ == samples_) return WORK_DONE;
    flight_.landed.wait(sent_ == 0 ? samples_ + 1 : sent_ - 1);
    static_cast<float*>(outputs[0])[0] = 1.0F;
    ++sent_;
    flight_.left = now_ns();
    return 1;
  }

 private:
  Flight& flight_;
  std::size_t samples_;
  std::size_t sent_ = 0;
};

class Landing final : public gr::sync_block {
 public:
  explicit Landing(Flight& flight)
      : gr::sync_block("landing", gr::io_signature::make(1, 1, sizeof(float)), gr::io_signature::make(0, 0, 0)),
        flight_(flight) {}

  int work(int items, gr_vector_const_void_star&, gr_vector_void_star&) override {
    flight_.ages.push_back(now_ns() - flight_.left);
    flight_.landed += static_cast<std::size_t>(items);
    flight_.landed.notify_one();
    return items;
  }

 private:
  Flight& flight_;
};

}  // namespace

void radio_multiply(int blocks, std::size_t samples, bool low_latency) {
  auto top = gr::make_top_block("multiply");
  gr::block_sptr last = gr::blocks::null_source::make(sizeof(float));
  for (int b = 0; b < blocks; ++b) {
    auto multiply = gr::blocks::multiply_const_ff::make(1.0F + 1e-3F * static_cast<float>(b + 1));
    top->connect(last, 0, multiply, 0);
    last = multiply;
  }
  auto head = gr::blocks::head::make(sizeof(float), samples);
  top->connect(last, 0, head, 0);
  top->connect(head, 0, gr::blocks::null_sink::make(sizeof(float)), 0);
  top->run(low_latency ? kLowLatencyItems : 100000000);
}

std::vector<double> radio_latency(std::size_t samples, bool low_latency) {
  Flight flight;
  flight.ages.reserve(samples);
  auto top = gr::make_top_block("latency");
  gr::block_sptr last = gnuradio::make_block_sptr<OneByOne>(flight, samples);
  for (int b = 0; b < 8; ++b) {
    auto copy = gr::blocks::copy::make(sizeof(float));
    top->connect(last, 0, copy, 0);
    last = copy;
  }
  top->connect(last, 0, gnuradio::make_block_sptr<Landing>(flight), 0);
  top->run(low_latency ? 1 : 100000000);
  return flight.ages;
}

}  // namespace bench
