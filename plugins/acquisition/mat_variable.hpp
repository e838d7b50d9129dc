#pragma once

#include <span>
#include <string>
#include <vector>

#include "mat_stream.hpp"

namespace bodeflow::acquisition {

/// The types of the numbers of a MATLAB file, by their codes there.
enum class MatNumber : std::uint32_t {
  int8 = 1,
  uint8 = 2,
  int16 = 3,
  uint16 = 4,
  int32 = 5,
  uint32 = 6,
  single = 7,
  real = 9,
  int64 = 12,
  uint64 = 13,
};

/// Bytes of a number; 0 for what is no number.
std::size_t size_of(MatNumber type);

/// `bytes` as numbers.
void convert(MatNumber type, bool big_endian, std::span<const char> bytes, double* to);

/// An array in a MATLAB v5 file, also one inside a struct.
struct MatArray {
  std::string name;  ///< with the structs around it: "s.u"
  std::string why;   ///< it holds no real numbers: "is text"; "" for numbers
  std::vector<std::uint64_t> shape;
  std::uint64_t count = 0;  ///< elements
  MatNumber type = MatNumber::real;
  std::int64_t position = 0;  ///< of the numbers, in the variable's stream
};

/// The arrays of the variable that begins here: itself, or those in a struct. Error: what is damaged, with the name.
Expected<std::vector<MatArray>> read_mat_variable(MatStream& stream, bool big_endian);

}  // namespace bodeflow::acquisition
