#include "trace_import.hpp"

#include <algorithm>
#include <cmath>

#include "identity.hpp"
#include "records/signals.hpp"
#include "register_value.hpp"

namespace bodeflow::drive::modbus {

using numerics::Expected;
using numerics::refused;

namespace {

constexpr std::int64_t kMostWords = 125;  // in one question, by the protocol

Expected<std::vector<std::uint16_t>> read_words(Link& link, const TraceBuffer& trace) {
  std::vector<std::uint16_t> words(static_cast<std::size_t>(trace.samples * trace.words_per_sample()));
  const auto all = static_cast<std::int64_t>(words.size());
  for (std::int64_t at = 0; at < all; at += kMostWords) {
    const auto count = static_cast<std::size_t>(std::min(kMostWords, all - at));
    auto read = link.read(trace.table, trace.address + static_cast<int>(at), {words.data() + at, count});
    if (!read) return tl::make_unexpected(read.error());
  }
  return words;
}

}  // namespace

Expected<std::vector<std::vector<double>>> import_trace(Link& link, const RegisterMap& map) {
  if (auto same = check_identity(link, map); !same) return tl::make_unexpected(same.error());
  const TraceBuffer& trace = map.trace.value();
  const auto done = read_value(link, map.registers[trace.done]);
  if (!done) return tl::make_unexpected(done.error());
  if (std::abs(*done - 1.0) > 0.0) {
    return refused(name_of(link.endpoint()) + ": the trace is not complete: " + name_of(map.registers[trace.done]) + " is " +
                   records::short_number(*done) + ", needed: 1");
  }
  const auto words = read_words(link, trace);
  if (!words) return tl::make_unexpected(words.error());
  std::vector<std::vector<double>> samples(trace.channels.size());
  const std::uint16_t* at = words->data();
  for (std::int64_t n = 0; n < trace.samples; ++n) {
    for (std::size_t c = 0; c < samples.size(); ++c) {
      samples[c].push_back(decoded(trace.channels[c], at));
      at += trace.channels[c].words();
      if (!std::isfinite(samples[c].back())) {
        return refused(name_of(link.endpoint()) + ": trace channel '" + trace.channels[c].name + "' is not finite at sample " +
                       std::to_string(n));
      }
    }
  }
  return samples;
}

}  // namespace bodeflow::drive::modbus
