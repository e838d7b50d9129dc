#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/record.hpp>
#include <string>
#include <vector>

namespace bodeflow::validation {

/// A number that each run of a sweep gave.
struct Quantity {
  std::string name;
  std::string unit;
  Eigen::VectorXd values;         ///< one a run
  Eigen::VectorXd own_deviation;  ///< the standard deviation that each run states of it; empty where they state none
};

/// The quantities of a record `sweep` that `sources` name, in that order.
///
/// A source is an array of the record (a number of each run among them, such as input_noise_variance), an entry of one,
/// `poles[1]` or `response[3,0,0]` with indices from 0, or one of `parameter_names`. An array gives all its entries; those of
/// `parameters` have the names and units that the record states, and standard deviations from `covariance`. A complex entry
/// gives two quantities, re(...) and im(...).
/// Errors, by name: another type of record, a source that is not there (with what is), an array that holds no numbers of
/// the runs, a value that is not finite (with its run).
Expected<std::vector<Quantity>> sweep_quantities(const RecordView& sweep, const std::vector<std::string>& sources);

/// How many runs a record `sweep` holds. Errors: another type, no run.
Expected<Eigen::Index> sweep_runs(const RecordView& sweep);

}  // namespace bodeflow::validation
