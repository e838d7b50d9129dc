#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "system/command.hpp"

namespace bodeflow::test {

/// Chromium without a window, with one page, steered over its DevTools pipe as by a person's hand.
class Browser {
 public:
  /// `program` as browser() gives it.
  Browser(const std::string& program, int width, int height, bool dark);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void open(const std::string& address);
  /// The value of a JavaScript expression in the page; null where it throws.
  nlohmann::json value(const std::string& expression);
  /// Waits until the expression is true; false: not within `seconds`.
  bool becomes(const std::string& expression, double seconds = 20.0);
  /// What the page's console said, and its uncaught exceptions.
  const std::vector<std::string>& complaints() const { return complaints_; }
  /// The page as PNG, in full height.
  std::string screenshot();

 private:
  nlohmann::json call(const std::string& method, nlohmann::json parameters = nlohmann::json::object());
  nlohmann::json next();

  Folder profile_;
  int process_ = -1;
  int to_ = -1, from_ = -1;
  int number_ = 0;
  std::string session_, buffer_;
  std::vector<std::string> complaints_;
};

}  // namespace bodeflow::test
