#pragma once

#include <optional>
#include <vector>

#include "expected.hpp"
#include "model/joint_model.hpp"
#include "sampled/sampled_measurement.hpp"
#include "sampled/stretch.hpp"

namespace bodeflow::residual {

/// How a record is cut: stretches that are simulated from a state of their own, and which of their samples are rows.
struct Layout {
  struct Segment {
    Stretch samples;
    Eigen::Index window = 0;     ///< samples from the first on that determine the state
    Eigen::Index first_row = 0;  ///< sample of the first row, counted from the record's begin
    Eigen::Index rows = 0;
  };
  std::vector<Segment> segments;
  Eigen::Index stride = 1;  ///< samples from row to row
  bool integrates = false;
  Stretches row_stretches;  ///< in rows
  Eigen::Index rows = 0;
  std::string words;  ///< for the report
};

/// The cut that suits a base model with these values.
///
/// A plant that settles: one segment, whose state comes from its first part, 25 samples a state and at least its slowest time
/// constant (at most a fifth of the record); that part is no row. One that integrates: segments of four times its slowest
/// finite time constant, at least 50 samples a state and at most a fifth of the record, whose state comes from all of their
/// samples. `segment_s` above 0 overrides: segments of that length; at least the record: one segment as if the plant settled. A
/// plant without states: all samples but those within one period of the filter's corner from both ends, thinned out so that half
/// of the rate of the rows is at least twice the corner.
/// Errors: fewer samples than 100 and than 50 a state.
Expected<Layout> make_layout(Eigen::Index samples, double sample_time_s, const BaseModel& base, const Eigen::VectorXd& values,
                             const std::vector<double>& known, double segment_s);

/// A part of a cut with about that many rows, spread evenly over the record: pieces with a state of their own each, or some of
/// the segments. Nothing where that spares less than half, or where a plant that integrates is simulated in one.
std::optional<Layout> excerpt_of(const Layout& whole, Eigen::Index rows);

}  // namespace bodeflow::residual
