#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/random.hpp>
#include <functional>
#include <string>

#include "model/joint_model.hpp"
#include "records/recording.hpp"
#include "trace/measurement.hpp"

/// Records and models for the tests of given records.
namespace bodeflow::residual::testing {

records::Recording recording(const Eigen::VectorXd& input, const Eigen::VectorXd& output, double rate_hz,
                             const std::string& input_unit = "N", const std::string& output_unit = "m");

/// The value, or a failed test with the reason.
template <class T>
T value_of(numerics::Expected<T> result) {
  if (!result) throw std::runtime_error(result.error().text);
  return *std::move(result);
}

/// An effect at the first place of its kinds, for a place of ordinary sizes.
template <class E>
Addition addition(const BaseModel& base, Situation situation = {}) {
  Addition a;
  DescribeEffect describe(a.what);
  E::describe(describe);
  a.effect = std::make_shared<E>();
  const std::vector<Place> places = base.places();
  for (std::size_t p = places.size(); p-- > 0;)
    for (const std::string& kind : a.what.kinds)
      if (places[p].kind == kind) a.place = p;
  if (a.place != Addition::kNoPlace) {
    situation.place = places[a.place];
    situation.place.coefficient = situation.place.flow = situation.place.stored = situation.place.effort = 1.0;
  }
  a.parameters = a.effect->parameters(situation);
  a.situation = situation;
  a.label = a.what.name();
  return a;
}

/// Seeded white noise of unit variance behind e[n] = a e[n-1] + w[n] (scaled to unit variance).
Eigen::VectorXd coloured_noise(std::uint64_t seed, Eigen::Index samples, double a);

/// Runge-Kutta 4 of dx/dt = f(x, u) with the input held over each sample, `steps` a sample; the state at each sample.
Eigen::MatrixXd integrated(const std::function<Eigen::VectorXd(const Eigen::VectorXd& x, double u)>& f, Eigen::VectorXd x,
                           const Eigen::VectorXd& input, double sample_time_s, int steps);

double rms(const Eigen::VectorXd& x);

}  // namespace bodeflow::residual::testing
