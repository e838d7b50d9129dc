#include "generate/size.hpp"

namespace battery {
namespace {

/// What the fit needs of a record.
struct Lines {
  std::vector<double> omega;
  std::vector<Complex> input, output;
};

Lines lines_of(const Drive& d, const Series& y) {
  Series mean(d.period, 0.0);
  for (std::size_t n = d.period; n < y.size(); ++n) mean[n % d.period] += y[n] / static_cast<double>(kPeriods - 1);
  Lines l;
  for (std::size_t j = 0; j < d.lines.size(); ++j) {
    l.omega.push_back(d.omega(j));
    l.input.push_back(d.line(j));
  }
  l.output = coefficients(mean, d.lines);
  return l;
}

std::vector<Complex> misses(const Plant& plant, const std::vector<Lines>& records, const std::vector<double>& parameters) {
  std::vector<Complex> r;
  for (const Lines& l : records) {
    for (std::size_t j = 0; j < l.omega.size(); ++j)
      r.push_back(l.output[j] - plant.response(parameters, l.omega[j]) * l.input[j]);
  }
  return r;
}

double sum_of_squares(const std::vector<Complex>& r) {
  double sum = 0.0;
  for (const Complex& c : r) sum += std::norm(c);
  return sum;
}

/// Solves a symmetric positive definite system (Cholesky), in place.
std::vector<double> solve(std::vector<std::vector<double>> a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      a[i][j] = i == j ? std::sqrt(a[i][i]) : a[i][j] / a[j][j];
    }
    for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return b;
}

/// Levenberg-Marquardt over the logarithms of the parameters, from the true ones. Gives the least sum of squares.
double refitted(const Plant& plant, const std::vector<Lines>& records) {
  constexpr int kSteps = 30;
  constexpr double kNudge = 1e-5, kEnough = 1e-9;
  std::vector<double> p = plant.parameters();
  std::vector<Complex> r = misses(plant, records, p);
  double least = sum_of_squares(r), damp = 1e-6;
  for (int step = 0; step < kSteps; ++step) {
    std::vector<std::vector<Complex>> slopes;
    for (std::size_t i = 0; i < p.size(); ++i) {
      auto moved = p;
      moved[i] *= std::exp(kNudge);
      slopes.push_back(misses(plant, records, moved));
      for (std::size_t j = 0; j < r.size(); ++j) slopes[i][j] = (slopes[i][j] - r[j]) / kNudge;
    }
    std::vector<std::vector<double>> normal(p.size(), std::vector<double>(p.size(), 0.0));
    std::vector<double> right(p.size(), 0.0);
    for (std::size_t i = 0; i < p.size(); ++i) {
      for (std::size_t k = 0; k < p.size(); ++k) {
        for (std::size_t j = 0; j < r.size(); ++j) normal[i][k] += std::real(std::conj(slopes[i][j]) * slopes[k][j]);
      }
      for (std::size_t j = 0; j < r.size(); ++j) right[i] -= std::real(std::conj(slopes[i][j]) * r[j]);
    }
    for (std::size_t i = 0; i < p.size(); ++i) normal[i][i] *= 1.0 + damp;
    const auto change = solve(normal, right);
    auto next = p;
    for (std::size_t i = 0; i < p.size(); ++i) next[i] *= std::exp(std::clamp(change[i], -0.5, 0.5));
    const auto trial = misses(plant, records, next);
    const double sum = sum_of_squares(trial);
    if (!(sum < least)) {
      damp *= 10.0;
      if (damp > 1e6) break;
      continue;
    }
    const bool done = least - sum < kEnough * least;
    p = next;
    r = trial;
    least = sum;
    damp = std::max(damp * 0.1, 1e-12);
    if (done) break;
  }
  return least;
}

}  // namespace

double model_error(const Plant& plant, const std::vector<Drive>& drives, const std::vector<Series>& outputs) {
  std::vector<Lines> records;
  double rest = 0.0;  // mean square of what is not at the excited lines of the mean period
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const Series steady(outputs[i].begin() + static_cast<std::ptrdiff_t>(drives[i].period), outputs[i].end());
    const double all = mean_square(steady);
    if (!std::isfinite(all)) return INFINITY;
    records.push_back(lines_of(drives[i], outputs[i]));
    rest += all - 0.5 * sum_of_squares(records.back().output);
  }
  return std::sqrt(std::max(rest + 0.5 * refitted(plant, records), 0.0) / static_cast<double>(drives.size()));
}

}  // namespace battery
