#include "radio.hpp"

#include <gnuradio/blocks/complex_to_mag_squared.h>
#include <gnuradio/blocks/head.h>
#include <gnuradio/blocks/integrate.h>
#include <gnuradio/blocks/multiply_conjugate_cc.h>
#include <gnuradio/blocks/null_sink.h>
#include <gnuradio/blocks/vector_source.h>
#include <gnuradio/fft/fft_v.h>
#include <gnuradio/fft/window.h>
#include <gnuradio/top_block.h>

namespace bench {
namespace {

/// Samples of one signal, period by period, and their spectra.
gr::basic_block_sptr spectra_of(const gr::top_block_sptr& top, const std::vector<float>& period, std::size_t periods) {
  const auto size = static_cast<int>(period.size());
  auto source = gr::blocks::vector_source_f::make(period, true, static_cast<unsigned>(size));
  auto head = gr::blocks::head::make(sizeof(float) * period.size(), periods);
  auto fft = gr::fft::fft_v<float, true>::make(size, gr::fft::window::rectangular(size), false, 1);
  top->connect(source, 0, head, 0);
  top->connect(head, 0, fft, 0);
  return fft;
}

template <class Integrate>
void sum_up(const gr::top_block_sptr& top, const gr::basic_block_sptr& from, std::size_t item, int periods, int size) {
  auto sum = Integrate::make(periods, size);
  top->connect(from, 0, sum, 0);
  top->connect(sum, 0, gr::blocks::null_sink::make(item * static_cast<std::size_t>(size)), 0);
}

}  // namespace

void radio_sums(const std::vector<float>& input, const std::vector<float>& output, std::size_t periods) {
  const auto size = static_cast<int>(input.size());
  const int count = static_cast<int>(periods);
  auto top = gr::make_top_block("spectra");
  const auto u = spectra_of(top, input, periods), y = spectra_of(top, output, periods);
  for (const auto& spectrum : {u, y}) {
    auto power = gr::blocks::complex_to_mag_squared::make(static_cast<std::size_t>(size));
    top->connect(spectrum, 0, power, 0);
    sum_up<gr::blocks::integrate_ff>(top, power, sizeof(float), count, size);
    sum_up<gr::blocks::integrate_cc>(top, spectrum, sizeof(gr_complex), count, size);
  }
  auto cross = gr::blocks::multiply_conjugate_cc::make(static_cast<std::size_t>(size));
  top->connect(y, 0, cross, 0);
  top->connect(u, 0, cross, 1);
  sum_up<gr::blocks::integrate_cc>(top, cross, sizeof(gr_complex), count, size);
  top->run();
}

}  // namespace bench
