#pragma once

#include <string>
#include <vector>

#include "common/json.hpp"

namespace battery {

/// What a tracer said of a case.
struct Answer {
  bool failed = true;
  std::string message;  ///< where it failed
  std::string verdict;
  std::vector<std::string> effects, equivalents;  ///< names alone, without a place
  std::vector<std::string> parameter_names, parameter_units;
  std::vector<double> parameters, parameter_std;
  double error_before = 0.0, error_after = 0.0, floor = 0.0;
  bool leak = false, at_floor = false;
  std::vector<std::string> class_names, class_records;
  std::vector<double> class_p;  ///< records x classes, of the model without any effect
  std::vector<std::string> candidate_names;
  std::vector<double> candidate_p;
};

/// Reads a result file of `bodeflow trace`, or its record alone; {"failed": code, "message": ...} where it gave none.
Answer read_answer(const Json& file);

/// What was hidden.
struct Truth {
  std::string number, plant, kind, effect;
  double size = 0.0;
  struct Value {
    std::string name, unit;
    double value = 0.0;
  };
  std::vector<Value> values;
};

std::vector<Truth> read_truth(const Json& file);

}  // namespace battery
