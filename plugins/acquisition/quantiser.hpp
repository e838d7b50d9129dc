#pragma once

#include <bodeflow/numerics/error.hpp>
#include <cstdint>
#include <optional>
#include <vector>

namespace bodeflow::acquisition {

/// The static characteristic of an analog-to-digital converter.
struct ConverterSpec {
  double low = -1.0, high = 1.0;              ///< range
  std::optional<int> bits{};                  ///< 1 to 32; none: no rounding
  double gain_error = 0.0;                    ///< relative
  double offset_error = 0.0;                  ///< in the unit of the input
  std::vector<std::int64_t> missing_codes{};  ///< 0 to 2^bits - 1
  std::vector<double> nonlinearity_lsb{};     ///< at equally spaced points over the range, straight between
};

/// What a converter makes of one value.
struct Converted {
  double value = 0.0;
  bool clipped = false;
};

/// Mid-tread conversion: v' = (1 + gain error) v + offset error; code = round((v' - low) / LSB + nonlinearity), LSB = (high -
/// low) / 2^bits, limited to 0 .. 2^bits - 1; the value is low + code LSB. So the middle of a symmetric range is a level of its
/// own, and the highest level lies one LSB below `high`. A value whose code had to be limited is clipped. A missing code's share
/// of the range goes to the codes beside it, half each. Without bits v' is limited to low .. high. Reference: IEEE Std 1241-2010,
/// Terminology and Test Methods for Analog-to-Digital Converters.
class Quantiser {
 public:
  /// Errors: a range that does not rise, missing codes without bits, out of range or all of them, a nonlinearity without bits, of
  /// fewer than two points or not finite.
  static numerics::Expected<Quantiser> make(const ConverterSpec& spec);

  Converted convert(double v) const;

  /// LSB; 0 without bits.
  double step() const { return step_; }

 private:
  struct Missing {
    double code, lower, upper;  ///< lower < 0: none below; upper beyond the highest code: none above
  };

  double nonlinearity(double position) const;
  double available(double code, double position) const;

  ConverterSpec spec_;
  double step_ = 0.0, highest_ = 0.0;
  std::vector<Missing> missing_;
};

}  // namespace bodeflow::acquisition
