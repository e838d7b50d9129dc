// What models of every second line leave at the lines between them, by method and order. Figures for the READMEs of
// plugins/sanathanan_koerner and plugins/subspace; no peers, no times.
//   fits_validation                  the examples
//   fits_validation FILE ORDER ...   the responses of a file

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <string>

#include "examples.hpp"
#include "methods.hpp"

namespace {

double rms(const Eigen::MatrixXd& error) { return error.norm() / std::sqrt(static_cast<double>(error.size())); }

void validate(const bench::Example& e, Eigen::Index order) {
  std::vector<Eigen::Index> fitted, between;
  for (Eigen::Index k = 0; k < e.data.lines(); ++k) (k % 2 == 0 ? fitted : between).push_back(k);
  const auto part = lines_of(e.data, fitted), others = lines_of(e.data, between);
  fmt::print("{}: {} poles, {} lines fitted, {} between\n", e.name, order, part.lines(), others.lines());
  fmt::print("{:<32}{:>12}{:>12}{:>14}{:>14}{:>10}\n", "", "rms fitted", "max fitted", "rms between", "max between", "unstable");
  for (const bench::Method& method : bench::methods()) {
    const auto model = method.fit(part, e.ports, order);
    if (!model) {
      fmt::print("{:<32}{:>12}\n", method.name, "no model");
      continue;
    }
    const auto at = bench::errors(part, model->system), off = bench::errors(others, model->system);
    fmt::print("{:<32}{:>12.3g}{:>12.3g}{:>14.3g}{:>14.3g}{:>10}\n", method.name, rms(at), at.maxCoeff(), rms(off),
               off.maxCoeff(), (model->poles.real().array() > 0.0).count());
  }
  fmt::print("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count > 2) {
    std::vector<Eigen::Index> orders;
    for (int i = 2; i < count; ++i) orders.push_back(std::stol(arguments[i]));
    const bench::Example one = bench::measured(arguments[1], arguments[1], {}, {}, orders);
    for (const Eigen::Index order : orders) validate(one, order);
    return 0;
  }
  for (const bench::Example& e : bench::examples())
    for (const Eigen::Index order : e.orders) validate(e, order);
} catch (const std::exception& problem) {
  fmt::print(stderr, "{}\n", problem.what());
  return 1;
}
