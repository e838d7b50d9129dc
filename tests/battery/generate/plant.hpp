#pragma once

#include <string>
#include <vector>

#include "generate/drive.hpp"

namespace battery {

/// Sizes of the clean plant's signals at level 1, by which effects are scaled.
struct Scale {
  double input_rms = 0.0;
  double output_rms = 0.0;
  double output_peak = 0.0;
};

/// A plant as its declared model describes it, with parameters that were drawn.
class Plant {
 public:
  virtual ~Plant() = default;

  virtual std::string name() const = 0;
  virtual std::string input_unit() const = 0;
  virtual std::string output_unit() const = 0;
  virtual double sample_time() const = 0;
  virtual double input_rms() const = 0;
  virtual bool input_is_measured() const = 0;
  virtual std::vector<int> line_choice() const = 0;  ///< before some are left out

  /// The output on the grid of substeps, settling included, when nothing is hidden.
  virtual Series clean(const Drive& d) const = 0;
  /// Positive numbers that the response is a function of.
  virtual std::vector<double> parameters() const = 0;
  /// From the samples of the input to those of the output, in the steady state.
  virtual Complex response(const std::vector<double>& parameters, double omega) const = 0;
};

constexpr std::size_t kPeriodSamples = 2048;

}  // namespace battery
