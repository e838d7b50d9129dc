#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace bodeflow::numerics {

/// Why data given to an algorithm was refused, as one sentence with the value found and the value allowed.
struct Error {
  std::string text;
};

template <class T>
using Expected = tl::expected<T, Error>;

/// The refusal as what a function of type Expected<T> returns.
inline tl::unexpected<Error> refused(std::string text) { return tl::make_unexpected(Error{std::move(text)}); }

}  // namespace bodeflow::numerics
