#pragma once

#include <bodeflow/abi.h>

#include <bodeflow/error.hpp>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace bodeflow {
inline namespace v0 {

/// A row-major matrix of doubles.
struct Matrix {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> values;  ///< rows x columns

  double operator()(std::size_t i, std::size_t j) const { return values[i * columns + j]; }
};

/// A path, given by the graph relative to the graph file and handed over as an absolute one.
struct File {
  std::string path;
};

/// A parameter's value as the C++ layer keeps it; the fields of bf_parameter_value, owned.
struct StoredValue {
  std::uint32_t type = 0;
  bool given = false;
  std::uint32_t rows = 0;
  std::uint32_t columns = 1;
  std::int64_t integer = 0;
  std::vector<double> numbers;
  std::vector<std::int64_t> integers;
  std::vector<std::string> strings;

  /// Copies what the host gives. A value of equal or smaller size than the one before allocates nothing.
  void assign(const bf_parameter_value& v) {
    type = v.type;
    given = v.given != 0;
    rows = v.rows;
    columns = v.columns;
    integer = v.integer;
    numbers.clear();
    integers.clear();
    switch (v.type) {
      case BF_NUMBER:
      case BF_NUMBERS:
        copy(numbers, v.numbers, rows);
        break;
      case BF_COMPLEX_LIST:
        copy(numbers, v.numbers, std::size_t{2} * rows);
        break;
      case BF_MATRIX:
        copy(numbers, v.numbers, std::size_t{rows} * columns);
        break;
      case BF_INTEGERS:
        copy(integers, v.integers, rows);
        break;
      case BF_STRING:
      case BF_CHOICE:
      case BF_FILE:
      case BF_STRINGS:
        copy(strings, v.strings, rows);
        break;
      case BF_BOOL:
      case BF_INTEGER:
        break;
      default:
        fail("the host gives a parameter of the unknown type " + std::to_string(v.type));
    }
  }

 private:
  template <class To, class From>
  static void copy(std::vector<To>& to, const From* from, std::size_t count) {
    if (count != 0 && from == nullptr) fail("the host gives a parameter without its values");
    to.resize(count);
    for (std::size_t i = 0; i < count; ++i) to[i] = from[i];
  }
};

/// The BF_* parameter type of a C++ type; 0 for a type that is none.
template <class T>
constexpr std::uint32_t parameter_type() {
  if constexpr (std::is_same_v<T, bool>) {
    return BF_BOOL;
  } else if constexpr (std::is_integral_v<T>) {
    return BF_INTEGER;
  } else if constexpr (std::is_floating_point_v<T>) {
    return BF_NUMBER;
  } else if constexpr (std::is_same_v<T, File>) {
    return BF_FILE;
  } else if constexpr (std::is_same_v<T, Matrix>) {
    return BF_MATRIX;
  } else if constexpr (std::is_same_v<T, std::vector<double>>) {
    return BF_NUMBERS;
  } else if constexpr (std::is_same_v<T, std::vector<std::int64_t>>) {
    return BF_INTEGERS;
  } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
    return BF_STRINGS;
  } else if constexpr (std::is_same_v<T, std::vector<std::complex<double>>>) {
    return BF_COMPLEX_LIST;
  } else if constexpr (std::is_convertible_v<const T&, std::string>) {
    return BF_STRING;
  } else {
    return 0;
  }
}

/// The stored value of a default given in C++.
template <class T>
StoredValue stored_value(const T& value) {
  StoredValue s;
  s.type = parameter_type<T>();
  s.rows = 1;
  if constexpr (std::is_integral_v<T>) {
    s.integer = static_cast<std::int64_t>(value);
  } else if constexpr (std::is_floating_point_v<T>) {
    s.numbers = {static_cast<double>(value)};
  } else if constexpr (std::is_same_v<T, File>) {
    s.strings = {value.path};
  } else if constexpr (std::is_same_v<T, Matrix>) {
    s.numbers = value.values;
    s.rows = static_cast<std::uint32_t>(value.rows);
    s.columns = static_cast<std::uint32_t>(value.columns);
  } else if constexpr (std::is_same_v<T, std::vector<std::complex<double>>>) {
    for (const auto& z : value) {
      s.numbers.push_back(z.real());
      s.numbers.push_back(z.imag());
    }
    s.rows = static_cast<std::uint32_t>(value.size());
  } else if constexpr (std::is_convertible_v<const T&, std::string>) {
    s.strings = {std::string(value)};
  } else {
    if constexpr (std::is_same_v<T, std::vector<double>>) s.numbers = value;
    if constexpr (std::is_same_v<T, std::vector<std::int64_t>>) s.integers = value;
    if constexpr (std::is_same_v<T, std::vector<std::string>>) s.strings = value;
    s.rows = static_cast<std::uint32_t>(value.size());
  }
  return s;
}

}  // namespace v0
}  // namespace bodeflow
