#pragma once

#include "uff58.hpp"

namespace bodeflow::acquisition {

/// Reads the values of one function, in bounded memory.
class Uff58Values {
 public:
  /// `source` is this reader's alone.
  Uff58Values(ByteSource& source, const Uff58Function& function);

  /// Goes to a point, the first being 0.
  Expected<void, TextError> start(std::int64_t point);

  /// The next number (numbers_per_point() of them a point). Error: no number, or fewer or more than the header states.
  Expected<double, TextError> next();

  /// The line of the number just read; 0 for binary values.
  std::int64_t line() const { return line_; }

 private:
  Expected<double, TextError> next_text();
  Expected<double, TextError> next_binary();
  Expected<void, TextError> check_end();
  std::int64_t numbers() const { return function_->points * function_->numbers_per_point(); }

  ByteSource* source_;
  const Uff58Function* function_;
  LineReader lines_;
  std::size_t at_ = 0;      // in the line
  std::int64_t taken_ = 0;  // numbers read
  std::int64_t line_ = 0;
  std::vector<char> bytes_;
  std::size_t byte_ = 0;
};

}  // namespace bodeflow::acquisition
