#pragma once

#include <bodeflow/error.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace bodeflow::spectrum {

/// Where the experiments of a measurement stand in its stream.
struct Schedule {
  std::int64_t period = 0;           ///< N samples
  std::int64_t skip = 0;             ///< periods left out at the start of each experiment
  std::int64_t periods = 0;          ///< P averaged periods of each; 0: one experiment, to the end of the stream
  std::int64_t realisations = 1;     ///< M
  std::int64_t experiments = 1;      ///< of one realisation
  std::vector<std::int64_t> starts;  ///< first sample of each experiment; empty: one after the other from 0

  std::int64_t count() const { return realisations * experiments; }
  /// The first sample of experiment i in the stream, and the first that is averaged.
  std::int64_t start(std::int64_t i) const {
    return starts.empty() ? i * (skip + periods) * period : starts[static_cast<std::size_t>(i)];
  }
  std::int64_t averaged_from(std::int64_t i) const { return start(i) + skip * period; }
  /// The number of samples that the measurement needs: with P unknown, two averaged periods.
  std::int64_t needed() const { return averaged_from(count() - 1) + (periods > 0 ? periods : 2) * period; }
};

/// What is wrong with a schedule, in words; empty where nothing is.
std::string fault_of(const Schedule& schedule);

/// "experiment 2 of realisation 3": the place of experiment i, counted from 0.
std::string name_of(const Schedule& schedule, std::int64_t i);

}  // namespace bodeflow::spectrum
