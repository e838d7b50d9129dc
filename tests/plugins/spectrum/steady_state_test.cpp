#include <bodeflow/numerics/discretise.hpp>
#include <bodeflow/numerics/frequency_response.hpp>
#include <iostream>

#include "catch.hpp"
#include "periodic.hpp"
#include "spectrum/averaging_dft.hpp"
#include "spectrum/period_selection.hpp"
#include "spectrum/transient_removal.hpp"

using namespace bodeflow;
using namespace bodeflow::spectrum;
using namespace bodeflow::test;

namespace {

constexpr int kSamples = 256;

/// A resonance with a damping of 1 %, from rest: its transient has lost 1/e after 400 samples.
numerics::StateSpace light_plant() {
  const double omega = 0.25, damping = 0.01;
  Eigen::MatrixXd A(2, 2), B(2, 1), C(1, 2);
  A << 0.0, 1.0, -omega * omega, -2.0 * damping * omega;
  B << 0.0, omega * omega;
  C << 1.0, 0.0;
  return numerics::zero_order_hold(*numerics::make_state_space(A, B, C, {}), 1.0)->model;
}

Eigen::VectorXd simulated(const numerics::StateSpace& s, const Eigen::VectorXd& u) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(s.states()), y(u.size());
  for (Eigen::Index n = 0; n < u.size(); ++n) {
    y[n] = (s.C * x)(0, 0) + s.D(0, 0) * u[n];
    x = (s.A * x + s.B * u[n]).eval();
  }
  return y;
}

struct Errors {
  double rms = 0.0;   // of the response, over lines and runs
  double said = 0.0;  // rms of what the variance says
};

/// A measurement of `periods` from rest, the first `skip` not averaged, with each collector that `make` gives.
template <class Make>
Errors errors_of(int periods, int skip, double deviation, int runs, Make make) {
  const auto plant = light_plant();
  const auto lines = lines_of(2, 40);
  Eigen::VectorXd hz(static_cast<Eigen::Index>(lines.size()));
  for (std::size_t i = 0; i < lines.size(); ++i) hz[static_cast<Eigen::Index>(i)] = double(lines[i]) / kSamples;
  const auto truth = numerics::frequency_response(plant, hz);
  Errors e;
  for (int run = 0; run < runs; ++run) {
    numerics::Random random = numerics::Random::stream(1, static_cast<std::uint64_t>(run));
    const Eigen::VectorXd one = random_multisine(kSamples, lines, 1.0, random);
    const Eigen::VectorXd u = one.replicate(periods, 1);
    const Eigen::VectorXd y = simulated(plant, u) + noise(u.size(), deviation, random);
    auto collector = make();
    for (int p = skip; p < periods; ++p) {
      Eigen::MatrixXd frame(kSamples, 2);
      frame << u.segment(p * kSamples, kSamples), y.segment(p * kSamples, kSamples);
      collector.add(frame);
    }
    const auto moments = collector.moments();
    REQUIRE(moments);
    Measured m{{1, 1, 0}, kSamples, 1, {*moments}};
    const auto estimate = estimate_response(m, {lines, 0.0}, Form::errors_in_variables);
    REQUIRE(estimate);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      e.rms += std::norm(estimate->response(row, 0) - truth[i](0, 0));
      e.said += estimate->variance(row, 0);
    }
  }
  const double count = double(runs) * double(lines.size());
  return {std::sqrt(e.rms / count), std::sqrt(e.said / count)};
}

AveragingDft plain() { return AveragingDft(kSamples, 1); }
TransientRemoval removing() { return TransientRemoval(kSamples, Layout{}); }

}  // namespace

TEST_CASE("transient removal: beats doing nothing and skipping a period on a lightly damped plant") {
  const Errors nothing = errors_of(4, 0, 0.01, 20, plain), skipped = errors_of(4, 1, 0.01, 20, plain),
               removed = errors_of(4, 0, 0.01, 20, removing);
  std::cout << "transient of a lightly damped plant, 4 periods: rms error " << nothing.rms << " as it is, " << skipped.rms
            << " without the first period, " << removed.rms << " removed; its variance says " << removed.said << "\n";
  CHECK(removed.rms < 0.2 * nothing.rms);
  CHECK(removed.rms < 0.4 * skipped.rms);
}

TEST_CASE("transient removal: without a transient it costs little, and its variance is true") {
  // Circular data: steady from the first sample.
  const auto lines = lines_of(2, 40);
  const auto G = resonance(20.0, 0.1);
  const int P = 4, runs = 200;
  double removed = 0.0, plain_error = 0.0, said = 0.0;
  for (int run = 0; run < runs; ++run) {
    numerics::Random random = numerics::Random::stream(2, static_cast<std::uint64_t>(run));
    const Eigen::VectorXd u = random_multisine(kSamples, lines, 1.0, random), y = filtered(u, G);
    TransientRemoval collector = removing();
    AveragingDft average = plain();
    for (int p = 0; p < P; ++p) {
      Eigen::MatrixXd frame(kSamples, 2);
      frame << u + noise(kSamples, 0.05, random), y + noise(kSamples, 0.1, random);
      collector.add(frame);
      average.add(frame);
    }
    const auto e = estimate_response({{1, 1, 0}, kSamples, 1, {*collector.moments()}}, {lines, 0.0}, Form::errors_in_variables);
    const auto a = average.estimate({lines, 0.0}, Form::errors_in_variables);
    REQUIRE(e);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const Complex truth = G(static_cast<int>(lines[i]));
      removed += std::norm(e->response(row, 0) - truth);
      plain_error += std::norm(a->response(row, 0) - truth);
      said += e->variance(row, 0);
    }
  }
  std::cout << "transient removal without a transient: variance " << removed / plain_error
            << " times that of plain averaging, predicted " << said / removed << " of it\n";
  CHECK(removed < 1.5 * plain_error);
  CHECK(said == Approx(removed).epsilon(0.15));
}

TEST_CASE("transient removal: too little data is refused by name") {
  TransientRemoval collector = removing();
  collector.add(Eigen::MatrixXd::Ones(kSamples, 2));
  CHECK(collector.moments().error().text == "the transient is told from the steady state by at least 2 periods; found 1");
  TransientRemoval small(5, Layout{});
  for (int p = 0; p < 2; ++p) small.add(Eigen::MatrixXd::Ones(5, 2));
  CHECK(small.moments().error().text == "a period of 5 samples is too short to remove the transient");
}

TEST_CASE("outliers: disturbed periods are left out, and the rest is averaged as it would be without them") {
  const auto lines = lines_of(2, 40);
  numerics::Random random(3);
  const Eigen::VectorXd u = random_multisine(kSamples, lines, 1.0, random), y = filtered(u, resonance(20.0, 0.1));
  PeriodSelection selection(kSamples, Layout{}, 3.0);
  AveragingDft expected(kSamples, 1);
  for (int p = 0; p < 9; ++p) {
    Eigen::MatrixXd frame(kSamples, 2);
    frame << u + noise(kSamples, 0.01, random), y + noise(kSamples, 0.01, random);
    if (p == 4) frame(100, 1) += 3.0;                                    // a knock
    if (p == 7) frame.col(1) = Eigen::VectorXd(frame.col(1).reverse());  // lost synchronism
    selection.add(frame);
    if (p != 4 && p != 7) expected.add(frame);
  }
  const auto found = selection.moments();
  REQUIRE(found);
  CHECK(found->left_out == std::vector<std::int64_t>{4, 7});
  CHECK(found->periods == 7);
  CHECK(found->mean == expected.moments()->mean);
  CHECK(found->variance == expected.moments()->variance);
}

TEST_CASE("outliers: usual noise leaves out nothing, and three periods have no median") {
  numerics::Random random(4);
  PeriodSelection selection(64, Layout{}, 3.0);
  for (int p = 0; p < 3; ++p) selection.add(noise(128, 1.0, random).reshaped(64, 2));
  CHECK(selection.moments().error().text == "outliers are told from the median of the periods: needed are at least 4; found 3");
  for (int p = 0; p < 30; ++p) selection.add(noise(128, 1.0, random).reshaped(64, 2));
  CHECK(selection.outliers().empty());
}

TEST_CASE("drift: a linear one over the record is taken off, exactly without noise") {
  const auto lines = lines_of(1, 20);
  numerics::Random random(5);
  const Eigen::VectorXd u = random_multisine(kSamples, lines, 1.0, random), y = 2.0 * u;
  AveragingDft with(kSamples, Layout{}, AveragingDft::Detrend::linear), without(kSamples, 1);
  for (int p = 0; p < 3; ++p) {
    Eigen::MatrixXd frame(kSamples, 2);
    frame << u, y + Eigen::VectorXd::LinSpaced(kSamples, 7.0 + 0.01 * p * kSamples, 7.0 + 0.01 * ((p + 1) * kSamples - 1));
    with.add(frame);
    without.add(frame);
  }
  const auto good = with.estimate({lines, 0.0}, Form::errors_in_variables),
             bad = without.estimate({lines, 0.0}, Form::errors_in_variables);
  REQUIRE(good);
  CHECK((good->response.array() - 2.0).abs().maxCoeff() < 1e-10);
  CHECK((bad->response.array() - 2.0).abs().maxCoeff() > 0.5);
  CHECK(bad->variance.maxCoeff() < 1e-20);  // no scatter shows it
}
