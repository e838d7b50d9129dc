#include "multi_band.hpp"

#include <algorithm>
#include <cmath>

#include "band_plan.hpp"
#include "measured.hpp"
#include "monomial.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

constexpr int kBandIterations = 10;  // of a band in one round; the paper's log has 2 to 8
constexpr int kLeastRounds = 3;      // before a further band joins, and after it
constexpr int kPoorerRounds = 3;     // in a row without a new best: the bands only pass errors on to each other

FitSettings band_settings(const MultiBandSettings& s, Eigen::Index order) {
  return {order, s.weight_exponent, true, {kBandIterations, 1e-4, 3}};
}

Data in_band(const Data& data, const BandModel& band, const Eigen::MatrixXcd& wanted, const MultiBandSettings& s) {
  const Eigen::VectorXd tiers = tiered_weights(data.omega_rad_s, {band.low_rad_s, band.high_rad_s, s.below, s.above});
  return {data.omega_rad_s, wanted, tiers.asDiagonal() * data.weights};
}

Expected<Fit> fit_band(const Data& data, const BandModel& band, const MultiBandSettings& s) {
  const FitSettings settings = band_settings(s, band.order);
  const Plane plane{band.prewarp_rad_s, 0.0};
  if (s.monomial) return monomial_fit(data, plane, settings);
  const bool again = band.fit.denominator.size() > 0;
  return fit(data, plane, settings, again ? band.fit.denominator : Eigen::VectorXcd());
}

/// The bands as they are fitted in turns.
class Turns {
 public:
  Turns(const Data& data, const MultiBandSettings& settings, std::vector<BandModel> bands)
      : data_(data), settings_(settings), norm_(weighted_norm(data)) {
    best_.bands = std::move(bands);
    now_ = best_.bands;
  }

  /// Rounds over the first `count` bands until they settle.
  Expected<void> settle(std::size_t count, int most, const std::string& phase) {
    double before = INFINITY;
    int poorer = 0;
    for (int r = 0; r < most; ++r) {
      Round round{phase, std::vector<int>(now_.size(), 0), 0.0};
      for (std::size_t b = 0; b < count; ++b) {
        auto found = fit_band(in_band(data_, now_[b], data_.response - sum(b), settings_), now_[b], settings_);
        if (!found) return unexpected("band " + std::to_string(b + 1) + ": " + found.error().text);
        round.iterations[b] = static_cast<int>(found->course.errors.size());
        now_[b].fit = std::move(*found);
      }
      round.error = weighted_residual(data_, sum(now_.size())).norm() / norm_;
      log_.push_back(round);
      const bool better = count == now_.size() && (best_.error == 0.0 || round.error < best_.error);
      if (better) {
        best_.bands = now_;
        best_.error = round.error;
      }
      poorer = better || count < now_.size() ? 0 : poorer + 1;
      const bool settled = std::abs(round.error - before) <= settings_.tolerance * round.error;
      before = round.error;
      if (r + 1 >= kLeastRounds && (settled || poorer >= kPoorerRounds)) {
        best_.reason = settled ? "the error has settled" : "the error rises again; the best round is kept";
        return {};
      }
    }
    best_.reason = "the limit of rounds";
    return {};
  }

  MultiBandFit result() {
    best_.response = Eigen::MatrixXcd::Zero(data_.lines(), data_.channels());
    for (const BandModel& band : best_.bands) best_.response += band.fit.response;
    best_.log = log_;
    return best_;
  }

 private:
  /// The sum of all bands but one.
  Eigen::MatrixXcd sum(std::size_t but) const {
    Eigen::MatrixXcd total = Eigen::MatrixXcd::Zero(data_.lines(), data_.channels());
    for (std::size_t b = 0; b < now_.size(); ++b) {
      if (b != but && now_[b].fit.response.size() > 0) total += now_[b].fit.response;
    }
    return total;
  }

  const Data& data_;
  const MultiBandSettings& settings_;
  double norm_;
  std::vector<BandModel> now_;
  MultiBandFit best_;
  std::vector<Round> log_;
};

/// Lower bands first, a further one when they have settled.
Expected<MultiBandFit> in_turns(const Data& data, const MultiBandSettings& s, const std::vector<BandModel>& bands, int rounds,
                                const std::string& phase) {
  Turns turns(data, s, bands);
  for (std::size_t count = std::min<std::size_t>(2, bands.size()); count <= bands.size(); ++count) {
    const int most = count == bands.size() ? rounds : kLeastRounds;
    if (auto settled = turns.settle(count, most, phase); !settled) return unexpected(settled.error().text);
  }
  return turns.result();
}

MultiBandFit of_one(const Data& data, const Fit& one) {
  MultiBandFit m;
  m.bands = {{data.omega_rad_s[0], data.omega_rad_s[data.lines() - 1], one.model.order(), one.model.plane.prewarp_rad_s, one}};
  m.response = one.response;
  m.error = one.error();
  m.reason = "no division into bands is better than the fit in one band";
  return m;
}

}  // namespace

Expected<MultiBandFit> multi_band_fit(const Data& data, const MultiBandSettings& settings) {
  if (auto good = check(data); !good) return unexpected(good.error().text);
  if (auto good = check_plan(settings); !good) return unexpected(good.error().text);
  const auto bound = one_band(data, settings);
  if (!bound) return unexpected(bound.error().text);
  MultiBandFit best = of_one(data, *bound);
  std::vector<Round> log;
  const bool sought = settings.cuts_rad_s.empty();
  std::string why;
  for (const auto& cuts :
       sought ? cuts_to_try(data, settings.most_bands) : std::vector<std::vector<double>>{settings.cuts_rad_s}) {
    const auto bands = planned_bands(data, settings, cuts);
    if (!bands) {
      why = bands.error().text;
      continue;
    }
    const bool found_orders = settings.orders.empty();
    if (found_orders) {
      const auto first = in_turns(data, settings, *bands, kLeastRounds, "search");
      if (first) log.insert(log.end(), first->log.begin(), first->log.end());
    }
    auto all = in_turns(data, settings, *bands, settings.rounds, "final");
    if (!all) {
      why = all.error().text;
      continue;
    }
    log.insert(log.end(), all->log.begin(), all->log.end());
    if (!sought || all->error < best.error) best = std::move(*all);
  }
  if (!sought && best.bands.size() == 1 && settings.cuts_rad_s.size() > 0) return unexpected(why);
  best.log = std::move(log);
  best.one_band_error = bound->error();
  best.one_band_order = bound->model.order();
  return best;
}

Expected<numerics::StateSpace> state_space(const MultiBandFit& fit) {
  numerics::StateSpace sum;
  for (const BandModel& band : fit.bands) {
    auto one = state_space(band.fit.model);
    if (!one) return one;
    if (sum.D.size() == 0) {
      sum = std::move(*one);
      continue;
    }
    const Eigen::Index a = sum.states(), b = one->states();
    numerics::StateSpace both{Eigen::MatrixXd::Zero(a + b, a + b), Eigen::MatrixXd(a + b, 1),
                              Eigen::MatrixXd(sum.outputs(), a + b), sum.D + one->D, 0.0};
    both.A.topLeftCorner(a, a) = sum.A;
    both.A.bottomRightCorner(b, b) = one->A;
    both.B << sum.B, one->B;
    both.C << sum.C, one->C;
    sum = std::move(both);
  }
  return sum;
}

}  // namespace bodeflow::sanathanan_koerner
