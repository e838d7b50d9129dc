#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/frequency_response.hpp>
#include <bodeflow/numerics/random.hpp>
#include <cmath>

#include "plants/ladder.hpp"
#include "records/response.hpp"

/// Responses of windings with noise, for the diagnosis of changes.
namespace bodeflow::test {

/// A winding of that many sections, all slightly different, with resonances from some 10 kHz on.
inline plants::Ladder winding(std::size_t sections, std::uint64_t seed) {
  numerics::Random random(seed);
  const auto about = [&](double value) { return value * (1.0 + 0.1 * (2.0 * random.uniform() - 1.0)); };
  plants::Ladder l;
  for (std::size_t i = 0; i < sections; ++i) {
    l.inductance_h.push_back(about(1.5e-3));
    l.resistance_ohm.push_back(about(6.0));
    l.turn_capacitance_f.push_back(about(40e-12));
    l.earth_capacitance_f.push_back(about(600e-12));
    l.earth_conductance_s.push_back(about(2e-6));
  }
  l.pick_up_f = 100e-12;
  return l;
}

inline Eigen::VectorXd frequencies(Eigen::Index count, double first_hz = 2e3, double last_hz = 4e5) {
  Eigen::VectorXd f(count);
  for (Eigen::Index k = 0; k < count; ++k)
    f[k] = first_hz * std::pow(last_hz / first_hz, static_cast<double>(k) / static_cast<double>(count - 1));
  return f;
}

/// What is measured of it: noise of a share of |G| and of a share of the largest |G|, with its variance.
inline records::ResponseData measured(const plants::Ladder& ladder, const Eigen::VectorXd& f, std::uint64_t seed,
                                      double relative = 1e-3, double absolute = 1e-5) {
  const auto system = plants::ladder_system(ladder);
  const auto exact = numerics::frequency_response(*system, f);
  records::ResponseData r;
  r.form = "known_input";
  r.input_names = {"terminal"};
  r.output_names = {"pick_up"};
  r.response_units = {"1"};
  r.frequency_hz = f;
  r.response.resize(f.size(), 1);
  r.variance.resize(f.size(), 1);
  double largest = 0.0;
  for (const auto& g : exact) largest = std::max(largest, std::abs(g(0, 0)));
  numerics::Random random(seed);
  for (Eigen::Index k = 0; k < f.size(); ++k) {
    const std::complex<double> g = exact[static_cast<std::size_t>(k)](0, 0);
    r.variance(k, 0) = std::pow(relative * std::abs(g), 2) + std::pow(absolute * largest, 2);
    const double re = random.normal();
    r.response(k, 0) = g + std::sqrt(0.5 * r.variance(k, 0)) * std::complex<double>(re, random.normal());
  }
  return r;
}

}  // namespace bodeflow::test
