#pragma once

#include <bodeflow/record_layout.hpp>
#include <complex>
#include <cstdint>

namespace bodeflow {
inline namespace v0 {

/// Element type of a stream port that carries double or std::complex<double>, as what is connected to it gives.
struct Any {};

template <class T>
inline constexpr bool kIsStreamType = false;
template <>
inline constexpr bool kIsStreamType<double> = true;
template <>
inline constexpr bool kIsStreamType<std::complex<double>> = true;
template <>
inline constexpr bool kIsStreamType<Any> = true;

/// A stream input: its position among the block's stream inputs, and its name. T: double, std::complex<double> or Any.
template <class T>
struct In {
  static_assert(kIsStreamType<T>, "streams carry double, std::complex<double> or bodeflow::Any");
  int index;
  const char* name;
};

/// A stream output: its position among the block's stream outputs, and its name.
template <class T>
struct Out {
  static_assert(kIsStreamType<T>, "streams carry double, std::complex<double> or bodeflow::Any");
  int index;
  const char* name;
};

/// A message input: its position among the block's message inputs, and its name.
struct MessageIn {
  int index;
  const char* name;
};

/// A message output: its position among the block's message outputs, and its name.
struct MessageOut {
  int index;
  const char* name;
};

}  // namespace v0
}  // namespace bodeflow
