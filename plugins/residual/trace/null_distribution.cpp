#include "trace/null_distribution.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <optional>

namespace bodeflow::residual {
namespace {

// A parameter is one at which the effect vanishes if this part of it leaves less than kGone of the effect.
constexpr double kNearZero = 1e-5;
constexpr double kGone = 1e-2;
constexpr std::size_t kDraws = 2000;
constexpr double kAround = 8.0;
constexpr int kFirstPoints = 7, kIdle = 8;
// A law is simulated at each, what is linear is not.
constexpr std::size_t kAttempts = 150, kSlowAttempts = 16;
constexpr double kTail = 0.02;
constexpr std::size_t kKeptStarts = 2;
// Such a p of a single trial is below any level however many trials there were.
constexpr double kBeyondDoubt = 1e-12;
// A direction of which less is left beside those of the model is one that the model has already.
// Looks are good to a few thousandths, where the time counts to some per cent: what changes before the record is only seen as an
// end of a transient.
constexpr double kNothingNew = 1e-4, kNothingNewToLooks = 1e-2, kNothingNewInTime = 0.15;
// Neighbours on a fine grid share this part of their direction: the largest gain between them is then hardly above theirs.
constexpr double kAlike = 0.8;
constexpr std::size_t kMostPoints = 64;
// Of the amplitude at which the Jacobian of an effect is taken: near 0, yet above rounding.
constexpr double kSmall = 1e-3;
constexpr double kPi = 3.14159265358979323846;

/// The effect beside the settled fit, by its own parameters.
class Beside {
 public:
  Beside(const FitProblem& problem, const Fit& from, const Looks* looks) : problem_(problem), from_(from), looks_(looks) {
    at_.resize(problem.layout().size());
    Eigen::Index settled = 0;
    for (Eigen::Index i = 0; i < at_.size(); ++i) at_[i] = problem.is_settled(i) ? from.at[settled++] : 0.0;
    first_ = problem.layout().parameters().size() - problem.model().additions.back().parameters.size();
  }

  /// What the effect changes in the residual.
  Eigen::VectorXd change(const Eigen::VectorXd& own) const {
    Eigen::VectorXd c = at_;
    const Coordinates& layout = problem_.layout();
    for (std::size_t p = first_; p < layout.parameters().size(); ++p) {
      const FitParameter& parameter = layout.parameters()[p];
      const double v = own[static_cast<Eigen::Index>(p - first_)];
      for (std::size_t r = 0; r < layout.records(); ++r)
        c[layout.index(p, r)] = parameter.logarithmic ? std::log(v) : v / parameter.scale;
    }
    return looks_ != nullptr ? looks_->change(c) : Eigen::VectorXd(problem_.residual(c) - from_.residual);
  }

 private:
  const FitProblem& problem_;
  const Fit& from_;
  const Looks* looks_;
  Eigen::VectorXd at_;
  std::size_t first_ = 0;
};

/// The effect with some size: what starts at 0 is of its typical one.
Eigen::VectorXd sized(const std::vector<FitParameter>& own, Eigen::VectorXd start) {
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    const FitParameter& p = own[static_cast<std::size_t>(i)];
    if (start[i] == 0.0) start[i] = p.scale > p.high ? -p.scale : p.scale;
  }
  return start;
}

/// The parameters that make the effect vanish: one alone, or the fewest of one kind together. Those that may pass through 0 come
/// first: a width or a ratio makes many an effect vanish too, and is no size.
std::vector<Eigen::Index> vanishing(const Beside& beside, const std::vector<FitParameter>& own, const Eigen::VectorXd& start) {
  const double whole = beside.change(start).norm();
  if (!(whole > 0.0)) return {};
  const auto gone = [&](const Eigen::VectorXd& v) { return beside.change(v).norm() < kGone * whole; };
  const auto without = [&](const std::vector<Eigen::Index>& some) {
    Eigen::VectorXd v = start;
    for (const Eigen::Index i : some) v[i] *= kNearZero;
    return v;
  };
  for (const bool logarithmic : {false, true}) {
    std::vector<Eigen::Index> candidates, alone;
    for (Eigen::Index i = 0; i < start.size(); ++i) {
      const FitParameter& p = own[static_cast<std::size_t>(i)];
      if (p.logarithmic != logarithmic || p.low > 0.0 || p.high < 0.0) continue;
      candidates.push_back(i);
      if (gone(without({i}))) alone.push_back(i);
    }
    if (!alone.empty()) return {alone.front()};
    if (candidates.size() < 2 || !gone(without(candidates))) continue;
    for (std::size_t n = 0; n < candidates.size();) {  // leave out those that are not needed for it
      std::vector<Eigen::Index> fewer;
      for (const Eigen::Index i : candidates)
        if (i != candidates[n]) fewer.push_back(i);
      if (!fewer.empty() && gone(without(fewer))) {
        candidates = fewer;
      } else {
        ++n;
      }
    }
    return candidates;
  }
  return {};
}

/// Values that a parameter may have where the effect vanishes.
struct Range {
  Eigen::Index parameter = 0;
  double low = 0.0, high = 0.0;
  bool logarithmic = false;

  /// At that part of the way.
  double at(double part) const { return logarithmic ? low * std::pow(high / low, part) : low + (high - low) * part; }
};

/// A frequency: the band of the lines; what is bounded: its bounds; else a factor of 8 around the start.
Range range_of(Eigen::Index i, const FitParameter& p, double start, const Situation& s) {
  if (p.unit == "Hz" && s.line_hz.size() > 1 && s.line_hz.back() > s.line_hz.front() && s.line_hz.front() > 0.0)
    return {i, s.line_hz.front(), s.line_hz.back(), true};
  if (!p.logarithmic && std::isfinite(p.low) && std::isfinite(p.high)) return {i, p.low, p.high, false};
  if (start > 0.0) return {i, std::max(p.low, start / kAround), std::min(p.high, start * kAround), true};
  return {i, std::max(p.low, -kAround * p.scale), std::min(p.high, kAround * p.scale), false};
}

std::vector<Range> ranges_of(const Addition& effect, const std::vector<Eigen::Index>& amplitudes, const Eigen::VectorXd& start) {
  std::vector<Range> free;
  for (Eigen::Index i = 0; i < start.size(); ++i)
    if (std::find(amplitudes.begin(), amplitudes.end(), i) == amplitudes.end())
      free.push_back(range_of(i, effect.parameters[static_cast<std::size_t>(i)], start[i], effect.situation));
  return free;
}

/// What the effect can do near 0 at one point of its other parameters.
struct Score {
  Eigen::VectorXd point;
  Eigen::MatrixXd unit;  ///< orthonormal columns, one an amplitude, at right angles to what the model without it can do; or none
  double gain = 0.0;     ///< of the residual, linearly
  std::optional<Eigen::VectorXd> start;  ///< the point with the amplitudes that do it
};

/// The amplitudes of `point` that a linear fit gives; nothing where none has the right sign.
std::optional<Eigen::VectorXd> fitted(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
                                      const std::vector<FitParameter>& own, const std::vector<Eigen::Index>& amplitudes,
                                      Eigen::VectorXd point) {
  const Eigen::VectorXd factor = columns.colPivHouseholderQr().solve(-residual);
  for (std::size_t a = 0; a < amplitudes.size(); ++a) {
    const FitParameter& p = own[static_cast<std::size_t>(amplitudes[a])];
    double& value = point[amplitudes[a]];
    value *= kSmall * factor[static_cast<Eigen::Index>(a)];
    if (!std::isfinite(value)) return {};
    const bool wrong = value < p.low || value > p.high || (p.logarithmic && !(value > 0.0));
    if (wrong && amplitudes.size() == 1) return {};
    if (wrong) value = p.logarithmic ? std::abs(point[amplitudes[a]]) : 0.0;
  }
  return point;
}

class Scorer {
 public:
  Scorer(const Beside& beside, const Fit& from, const std::vector<FitParameter>& own, const std::vector<Eigen::Index>& amplitudes,
         double nothing_new, const Eigen::VectorXd& probe)
      : beside_(beside), own_(own), amplitudes_(amplitudes), nothing_new_(nothing_new) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(from.jacobian);
    const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(from.jacobian.rows(), from.jacobian.cols());
    const Eigen::VectorXd change = beside.change(probe);
    for (Eigen::Index r = 0; r < q.rows(); ++r)
      if (change[r] != 0.0 || !q.row(r).isZero(0.0)) rows_.push_back(r);
    q_ = q(rows_, Eigen::all);
    residual_ = from.residual(rows_);
  }

  /// Of directions: those that the effect or the model can change at all. Between the lines of a period it may be none.
  Eigen::Index rows() const { return q_.rows(); }

  Score at(const Eigen::VectorXd& point) const {
    const auto count = static_cast<Eigen::Index>(amplitudes_.size());
    Score s;
    s.point = point;
    Eigen::MatrixXd columns(q_.rows(), count), unit(q_.rows(), count);
    for (Eigen::Index a = 0; a < count; ++a) {
      Eigen::VectorXd single = point;
      for (Eigen::Index b = 0; b < count; ++b)
        single[amplitudes_[static_cast<std::size_t>(b)]] *= a == b ? kSmall : kSmall * kNearZero;
      Eigen::VectorXd d = beside_.change(single)(rows_);
      const double whole = d.norm();
      if (!d.allFinite() || !(whole > 0.0)) return s;
      d -= q_ * (q_.transpose() * d);
      columns.col(a) = d;
      d -= unit.leftCols(a) * (unit.leftCols(a).transpose() * d);
      if (!(d.norm() > nothing_new_ * whole)) return s;
      unit.col(a) = d.normalized();
    }
    s.gain = (unit.transpose() * residual_).squaredNorm();
    s.start = fitted(columns, residual_, own_, amplitudes_, point);
    s.unit = std::move(unit);
    return s;
  }

 private:
  const Beside& beside_;
  const std::vector<FitParameter>& own_;
  const std::vector<Eigen::Index>& amplitudes_;
  double nothing_new_;
  std::vector<Eigen::Index> rows_;
  Eigen::MatrixXd q_;
  Eigen::VectorXd residual_;
};

/// How much of the one's directions lies in the other's, 0 to 1.
double alike(const Score& a, const Score& b) {
  return (a.unit.transpose() * b.unit).norm() / std::sqrt(static_cast<double>(a.unit.cols()));
}

void add(const Scorer& scorer, const Eigen::VectorXd& point, std::vector<Score>& all) {
  Score s = scorer.at(point);
  if (s.unit.cols() > 0) all.push_back(std::move(s));
}

/// Points along the one parameter that is free, until neighbours are alike.
void cover_line(const Scorer& scorer, const Range& range, std::vector<Score>& all) {
  if (all.empty()) return;
  Eigen::VectorXd point = all.front().point;
  for (int n = 0; n < kFirstPoints; ++n) {
    point[range.parameter] = range.at((n + 0.5) / kFirstPoints);
    add(scorer, point, all);
  }
  const auto before = [&](const Score& a, const Score& b) { return a.point[range.parameter] < b.point[range.parameter]; };
  std::stable_sort(all.begin(), all.end(), before);
  for (std::size_t n = 0; n + 1 < all.size() && all.size() < kMostPoints;) {
    const double low = all[n].point[range.parameter], high = all[n + 1].point[range.parameter];
    const double between = range.logarithmic ? std::sqrt(low * high) : 0.5 * (low + high);
    point[range.parameter] = between;
    Score s;
    if (between > low && between < high && alike(all[n], all[n + 1]) < kAlike) s = scorer.at(point);
    if (s.unit.cols() == 0) {
      ++n;
    } else {
      all.insert(all.begin() + static_cast<std::ptrdiff_t>(n) + 1, std::move(s));
    }
  }
}

/// Points anywhere in the ranges (seeded), until kIdle of them in a row bring nothing new.
void cover_volume(const Scorer& scorer, const std::vector<Range>& ranges, std::size_t attempts, std::vector<Score>& all) {
  if (all.empty()) return;
  numerics::Random random(1);
  int idle = 0;
  for (std::size_t n = 0; n < attempts && idle < kIdle; ++n) {
    Eigen::VectorXd point = all.front().point;
    for (const Range& r : ranges) point[r.parameter] = r.at(random.uniform());
    Score s = scorer.at(point);
    if (s.unit.cols() == 0) continue;
    const bool known = std::any_of(all.begin(), all.end(), [&](const Score& other) { return alike(s, other) > kAlike; });
    idle = known ? idle + 1 : 0;
    if (!known) all.push_back(std::move(s));
  }
}

/// Scores at the starts, and all over the ranges of what is free.
std::vector<Score> scores(const Scorer& scorer, const std::vector<Eigen::VectorXd>& starts, const std::vector<Range>& ranges,
                          std::size_t attempts) {
  std::vector<Score> all;
  for (const Eigen::VectorXd& start : starts) {
    add(scorer, start, all);
    if (ranges.empty()) break;
  }
  if (ranges.size() == 1) cover_line(scorer, ranges.front(), all);
  if (ranges.size() > 1) cover_volume(scorer, ranges, attempts, all);
  return all;
}

/// The largest gain over the points, for each of some draws of the noise.
std::vector<double> largest_gains(const Eigen::MatrixXd& unit, Eigen::Index per_point, bool one_sided) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> gram(unit.transpose() * unit);
  const Eigen::MatrixXd root = gram.eigenvectors() * gram.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  numerics::Random random(2);
  Eigen::VectorXd draw(unit.cols());
  std::vector<double> gains;
  for (std::size_t n = 0; n < kDraws; ++n) {
    for (double& d : draw) d = random.normal();
    const Eigen::VectorXd score = root * draw;
    double largest = 0.0;
    for (Eigen::Index g = 0; g < unit.cols(); g += per_point) {
      const double gain = one_sided && score[g] < 0.0 ? 0.0 : score.segment(g, per_point).squaredNorm();
      largest = std::max(largest, gain);
    }
    gains.push_back(largest);
  }
  std::sort(gains.begin(), gains.end());
  return gains;
}

double single(const Null& n, double gain) { return (n.one_sided ? 0.5 : 1.0) * numerics::chi_squared_tail(gain, n.freedom); }

double with_trials(double p, double trials) { return p < 1.0 ? -std::expm1(trials * std::log1p(-p)) : 1.0; }

Null of_tones(const FitProblem& problem, const Fit& from, const Eigen::VectorXd& start) {
  const Addition& tone = problem.model().additions.back();
  Null n;
  n.freedom = 0.0;
  Eigen::VectorXd values(from.values().size() + start.size());
  values << from.values(), start;
  for (const auto& r : problem.records()) n.freedom += static_cast<double>(r->eliminated(problem.model(), values));
  double bins = static_cast<double>(problem.rows()) / (2.0 * static_cast<double>(problem.records().size()));
  for (const FitParameter& p : tone.parameters)
    if (p.unit == "Hz" && std::isfinite(p.high))
      bins = std::min(bins, (p.high - std::max(p.low, 0.0)) * tone.situation.duration_s);
  n.trials = std::max(bins, 1.0);
  n.tone = true;
  return n;
}

}  // namespace

double Null::p(double gain) const {
  if (!(gain > 0.0)) return 1.0;
  if (!simulated.empty() && gain < simulated[static_cast<std::size_t>((1.0 - kTail) * static_cast<double>(simulated.size()))]) {
    const auto above = simulated.end() - std::lower_bound(simulated.begin(), simulated.end(), gain);
    return (static_cast<double>(above) + 1.0) / (static_cast<double>(simulated.size()) + 1.0);
  }
  const double between_bins = tone ? std::max(std::sqrt(kPi * gain / 6.0), 1.0) : 1.0;
  return with_trials(single(*this, gain), trials * between_bins);
}

double Null::p_of_look() const { return opposite > 0.0 ? 1.0 - p(opposite) : p(most); }

Null null_distribution(const FitProblem& problem, const Fit& from, const std::vector<Eigen::VectorXd>& own_starts, double gain,
                       const Looks* looks) {
  const Addition& effect = problem.model().additions.back();
  if (effect.what.acts == Acts::tone) return of_tones(problem, from, own_starts.front());
  std::vector<Eigen::VectorXd> starts;
  for (const Eigen::VectorXd& start : own_starts) starts.push_back(sized(effect.parameters, start));
  const Beside beside(problem, from, looks);
  const std::vector<Eigen::Index> amplitudes = vanishing(beside, effect.parameters, starts.front());
  Null n;
  n.amplitudes = amplitudes;
  n.freedom = 0.0;
  for (const Eigen::Index i : amplitudes) {
    const FitParameter& p = effect.parameters[static_cast<std::size_t>(i)];
    n.freedom += p.each_record ? static_cast<double>(problem.records().size()) : 1.0;
    n.one_sided = n.one_sided || (!p.each_record && (p.low == 0.0 || p.high == 0.0));
  }
  if (amplitudes.empty()) {
    n.freedom = static_cast<double>(problem.layout().size() - from.at.size());
    return n;
  }
  const std::vector<Range> ranges = ranges_of(effect, amplitudes, starts.front());
  const bool own = std::any_of(amplitudes.begin(), amplitudes.end(),
                               [&](Eigen::Index i) { return effect.parameters[static_cast<std::size_t>(i)].each_record; });
  const bool known =
      std::all_of(problem.records().begin(), problem.records().end(), [](const auto& r) { return r->floor_known(); });
  if (own || !known || single(n, gain) < kBeyondDoubt) {
    n.trials = ranges.empty() ? 1.0 : static_cast<double>(kMostPoints);
    return n;
  }
  const auto per_point = static_cast<Eigen::Index>(amplitudes.size());
  const double nothing_new = looks == nullptr ? kNothingNew : effect.what.nonstationary ? kNothingNewInTime : kNothingNewToLooks;
  const Scorer scorer(beside, from, effect.parameters, amplitudes, nothing_new, starts.front());
  std::vector<Score> found = scores(scorer, starts, ranges, effect.what.linear() || looks != nullptr ? kAttempts : kSlowAttempts);
  Eigen::MatrixXd unit(scorer.rows(), per_point * static_cast<Eigen::Index>(found.size()));
  for (std::size_t g = 0; g < found.size(); ++g)
    unit.middleCols(per_point * static_cast<Eigen::Index>(g), per_point) = found[g].unit;
  if (found.empty()) return n;
  std::stable_sort(found.begin(), found.end(), [](const Score& x, const Score& y) { return x.gain > y.gain; });
  for (const Score& s : found) {
    if (!s.start || n.starts.size() == kKeptStarts) continue;
    n.starts.push_back(*s.start);
    n.most = std::max(n.most, s.gain);
  }
  n.looked = true;
  n.nearest = n.starts.empty() ? found.front().point : n.starts.front();
  if (n.starts.empty())
    for (const Eigen::Index i : amplitudes) n.nearest[i] *= kSmall;
  if (n.starts.empty() && found.size() == 1) n.opposite = found.front().gain;
  if (unit.cols() <= per_point) return n;
  n.simulated = largest_gains(unit, per_point, n.one_sided && per_point == 1);
  const double limit = n.simulated[static_cast<std::size_t>((1.0 - kTail) * static_cast<double>(kDraws))];
  n.trials = std::max(std::log1p(-kTail) / std::log1p(-std::min(single(n, limit), 0.999)), 1.0);
  return n;
}

}  // namespace bodeflow::residual
