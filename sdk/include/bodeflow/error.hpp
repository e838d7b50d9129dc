#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

namespace bodeflow {

/// Why something could not be done: what was found, what is allowed.
struct Error {
  std::string text;

  bool operator==(const Error& other) const { return text == other.text; }
  bool operator!=(const Error& other) const { return !(*this == other); }
};

/// Thrown by `fail`. At the plugin border it becomes the block's error text.
class Failure : public std::runtime_error {
 public:
  explicit Failure(const std::string& text) : std::runtime_error(text) {}
};

/// Ends the call in progress with a reason for the user.
[[noreturn]] inline void fail(std::string_view reason) { throw Failure(std::string(reason)); }

/// Marks an error on its way into an Expected.
template <class E>
struct Unexpected {
  E error;
};
template <class E>
Unexpected(E) -> Unexpected<E>;

/// An Unexpected<Error> of that text, to be returned from a function that gives an Expected.
inline Unexpected<Error> unexpected(std::string text) { return {Error{std::move(text)}}; }

/// A value, or the reason why there is none. Reading the one that is absent throws (Failure, std::bad_variant_access).
template <class T, class E = Error>
class [[nodiscard]] Expected {
 public:
  using value_type = T;
  using error_type = E;

  template <class U = T, class = std::enable_if_t<std::is_constructible_v<T, U&&> && !std::is_same_v<std::decay_t<U>, Expected>>>
  Expected(U&& value) : held_(std::in_place_index<0>, std::forward<U>(value)) {}
  Expected(Unexpected<E> error) : held_(std::in_place_index<1>, std::move(error.error)) {}

  bool has_value() const noexcept { return held_.index() == 0; }
  explicit operator bool() const noexcept { return has_value(); }

  T& value() & { return require(), *std::get_if<0>(&held_); }
  const T& value() const& { return require(), *std::get_if<0>(&held_); }
  T&& value() && { return require(), std::move(*std::get_if<0>(&held_)); }

  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  template <class U>
  T value_or(U&& other) const {
    return has_value() ? **this : static_cast<T>(std::forward<U>(other));
  }

  E& error() { return std::get<1>(held_); }
  const E& error() const { return std::get<1>(held_); }

 private:
  void require() const {
    if (has_value()) return;
    if constexpr (std::is_same_v<E, Error>) {
      throw Failure(std::get<1>(held_).text);
    } else {
      throw std::bad_variant_access();
    }
  }

  std::variant<T, E> held_;
};

/// Success, or the reason why not.
template <class E>
class [[nodiscard]] Expected<void, E> {
 public:
  using value_type = void;
  using error_type = E;

  Expected() = default;
  Expected(Unexpected<E> error) : held_(std::in_place_index<1>, std::move(error.error)) {}

  bool has_value() const noexcept { return held_.index() == 0; }
  explicit operator bool() const noexcept { return has_value(); }
  E& error() { return std::get<1>(held_); }
  const E& error() const { return std::get<1>(held_); }

 private:
  std::variant<std::monostate, E> held_;
};

}  // namespace bodeflow
