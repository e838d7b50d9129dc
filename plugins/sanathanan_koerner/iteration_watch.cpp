#include "iteration_watch.hpp"

#include <cmath>

namespace bodeflow::sanathanan_koerner {
namespace {

constexpr double kWorthwhile = 1e-3;  // relative gain below which an iteration only wanders
constexpr double kRounding = 1e-13;   // error at which exact data are reproduced and nothing but rounding is left

}  // namespace

bool note(Course& course, double error) {
  course.errors.push_back(error);
  const bool better = std::isfinite(error) && (course.best < 0 || error < course.least());
  if (better) course.best = static_cast<int>(course.errors.size()) - 1;
  return better;
}

bool should_stop(Course& course, const StopRule& rule) {
  const auto count = static_cast<int>(course.errors.size());
  const auto stop = [&](bool converged, std::string reason) {
    course.converged = converged;
    course.reason = std::move(reason);
    return true;
  };
  const double last = course.errors.back();
  if (!std::isfinite(last)) return stop(false, "an iterate is not finite");
  if (count > 1) {
    const double before = course.errors[static_cast<std::size_t>(count) - 2];
    if (course.least() < kRounding && last > 0.5 * before) return stop(true, "the error is at the level of rounding");
    if (std::abs(last - before) <= rule.tolerance * last) return stop(true, "the error changes no more");
  }
  if (last == 0.0) return stop(true, "the error is at the level of rounding");
  if (count > rule.patience) {
    double earlier = course.errors.front();
    for (int i = 0; i < count - rule.patience; ++i) earlier = std::fmin(earlier, course.errors[static_cast<std::size_t>(i)]);
    if (course.least() > (1.0 - kWorthwhile) * earlier)
      return stop(true, "none of the last " + std::to_string(rule.patience) + " iterates is better by 0.1 %");
  }
  if (count >= rule.iterations) return stop(false, "the limit of " + std::to_string(rule.iterations) + " iterations");
  return false;
}

}  // namespace bodeflow::sanathanan_koerner
