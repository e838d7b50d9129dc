#include "radio.hpp"

#include <gnuradio/blocks/head.h>
#include <gnuradio/blocks/null_sink.h>
#include <gnuradio/blocks/null_source.h>
#include <gnuradio/filter/fir_filter_blk.h>
#include <gnuradio/filter/iir_filter_ffd.h>
#include <gnuradio/top_block.h>

#include <vector>

#include "hand.hpp"

namespace bench {

void radio_fir(std::size_t samples) {
  const auto h = fir_coefficients();
  auto top = gr::make_top_block("fir");
  auto head = gr::blocks::head::make(sizeof(float), samples);
  auto filter = gr::filter::fir_filter_fff::make(1, std::vector<float>(h.begin(), h.end()));
  top->connect(gr::blocks::null_source::make(sizeof(float)), 0, head, 0);
  top->connect(head, 0, filter, 0);
  top->connect(filter, 0, gr::blocks::null_sink::make(sizeof(float)), 0);
  top->run();
}

void radio_biquads(std::size_t samples) {
  auto top = gr::make_top_block("biquads");
  auto head = gr::blocks::head::make(sizeof(float), samples);
  top->connect(gr::blocks::null_source::make(sizeof(float)), 0, head, 0);
  for (const auto& c : biquad_coefficients()) {
    auto filter = gr::filter::iir_filter_ffd::make({c[0], c[1], c[2]}, {1.0, c[3], c[4]}, false);
    top->connect(head, 0, filter, 0);
    top->connect(filter, 0, gr::blocks::null_sink::make(sizeof(float)), 0);
  }
  top->run();
}

}  // namespace bench
