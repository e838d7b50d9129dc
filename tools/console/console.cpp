#include "console/console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <bodeflow/utf8.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>

namespace bodeflow::tools {
namespace {

bool coloured(int file) {
  const char* no_color = std::getenv("NO_COLOR");
  return isatty(file) != 0 && (no_color == nullptr || *no_color == '\0');
}

std::string painted(int file, const char* code, const std::string& text) {
  return coloured(file) ? fmt::format("\033[{}m{}\033[0m", code, text) : text;
}

/// Text whose bytes that are no UTF-8 (names from data files) are U+FFFD: a terminal may take them for commands.
std::string valid(const std::string& text) {
  std::string clean;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t length = 1;
    while (length <= 4 && !is_text(std::string_view(text).substr(at, length))) ++length;
    const bool fits = length <= 4;
    clean += fits ? text.substr(at, length) : "\xEF\xBF\xBD";
    at += fits ? length : 1;
  }
  return clean;
}

/// A lost terminal must not end a run: what can't be printed is left out.
void print_error(const std::string& text) { (void)std::fputs(valid(text).c_str(), stderr); }

}  // namespace

void say(const std::string& text) { print_error(text + "\n"); }
void say_warning(const std::string& text) { print_error(fmt::format("{} {}\n", painted(STDERR_FILENO, "33", "warning:"), text)); }
void say_error(const std::string& text) { print_error(fmt::format("{} {}\n", painted(STDERR_FILENO, "31", "error:"), text)); }

void say_problems(const Problems& problems) {
  for (const auto& problem : problems) print_error(fmt::format("{}\n", to_string(problem)));
  print_error(fmt::format(
      "{}\n", painted(STDERR_FILENO, "31", problems.size() == 1 ? "1 problem" : fmt::format("{} problems", problems.size()))));
}

std::string bold(const std::string& text) { return painted(STDOUT_FILENO, "1", text); }
std::string dim(const std::string& text) { return painted(STDOUT_FILENO, "2", text); }

struct ProgressLine::State {
  std::mutex mutex;
  bool terminal = isatty(STDERR_FILENO) != 0;
  bool shown = false;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

ProgressLine::ProgressLine() : state_(new State) {}

ProgressLine::~ProgressLine() {
  clear();
  delete state_;
}

void ProgressLine::show(const std::string& phase, const execute::Progress& progress) {
  const std::lock_guard lock(state_->mutex);
  if (!state_->terminal) return;
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - state_->start).count();
  if (wall < 0.5) return;
  std::string line = phase.empty() ? "" : phase + "  ";
  if (progress.total_s > 0.0) {
    line += fmt::format("{:3.0f} %  ", 100.0 * progress.time_s / progress.total_s);
    if (progress.rate > 0.0) line += fmt::format("{} left", duration_text((progress.total_s - progress.time_s) / progress.rate));
  } else {
    line += duration_text(progress.time_s) + " of signal";
  }
  print_error(fmt::format("\r{}\033[K", line));
  std::fflush(stderr);
  state_->shown = true;
}

void ProgressLine::clear() {
  const std::lock_guard lock(state_->mutex);
  if (state_->shown) print_error("\r\033[K");
  state_->shown = false;
}

std::string duration_text(double seconds) {
  if (seconds < 60.0) return fmt::format("{:.3g} s", seconds);
  const auto whole = static_cast<long>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string si(double value, const std::string& unit) {
  static constexpr std::array<const char*, 9> kPrefixes{"p", "n", "u", "m", "", "k", "M", "G", "T"};
  int index = 4;
  if (value != 0.0 && std::isfinite(value)) {
    index = 4 + static_cast<int>(std::floor(std::log10(std::abs(value)) / 3.0 + 1e-9));
    index = std::min(8, std::max(0, index));
  }
  return fmt::format("{:.4g} {}{}", value / std::pow(1000.0, index - 4), kPrefixes[static_cast<std::size_t>(index)], unit);
}

}  // namespace bodeflow::tools
