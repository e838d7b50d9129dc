#include "sampled/open_loop.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/linear_path.hpp"
#include "model/transition.hpp"
#include "sampled/noise_model.hpp"
#include "sampled/record_spectrum.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

// Values of the motion for each sample: of a law with corners or a memory, and of a smooth one.
constexpr int kFineRough = 4, kFineSmooth = 2;
// Chance that noise alone stands out at one of the lines.
constexpr double kChance = 1e-3;
// The flow over which a law may spread a jump: a part of what the jump changes itself within a step.
constexpr double kSpread = 0.05;
constexpr Eigen::Index kNoiseOrder = 10;
constexpr double kWeak = 1e-8;  // of the strongest direction of a state: not shown by the output

Complex s_at(double frequency_hz) { return {0.0, 2.0 * std::numbers::pi * frequency_hz}; }

/// What a reaction at a place moves there, for what it moves of the output.
struct MovedByOutput {
  Complex flow, stored;
};

MovedByOutput moved_at(const LinearPath& path, Eigen::Index place, Complex s) {
  Eigen::MatrixXcd g;
  path.plant(s, g);
  const Eigen::Index column = path.inputs() + place;
  const PlantMatrices& p = *path.matrices();
  const Complex output = g(0, column), flow = g(1 + place, column);
  Eigen::MatrixXcd stored;
  Resolvent(p.A, path.modes(), p.E.col(place), p.Cs.row(place)).at(s, stored);
  return {flow / output, (stored(0, 0) + p.Fs(place, place)) / output};
}

bool finite(Complex x) { return std::isfinite(x.real()) && std::isfinite(x.imag()); }

/// The linear plant from a reaction at the place to the output, moved from value to value.
struct Steps {
  Eigen::MatrixXd phi;
  Eigen::VectorXd from, to;  ///< by the reaction at the begin and at the end of a step, straight between
  Eigen::RowVectorXd output;
  double direct = 0.0;

  Steps(const PlantMatrices& p, Eigen::Index place, double step_s) : output(p.C), direct(p.F(0, place)) {
    const Transition t = transition(p.A, step_s);
    phi = t.phi;
    to = t.psi[1] * p.E.col(place) / step_s;
    from = t.psi[0] * p.E.col(place) - to;
  }
};

/// A stretch that is simulated from a state of its own.
struct Piece {
  Layout::Segment where;
  Eigen::VectorXd flow, stored;           ///< `fine` values a sample
  Eigen::MatrixXd by_state, from_window;  ///< the output by the state; the state by the output at the window
};

class LawLook final : public OpenLoop {
 public:
  LawLook(const SampledRecord& record, const JointModel& model, const Eigen::VectorXd& values, const Addition& effect,
          double unit)
      : record_(record),
        values_(values),
        path_(model, values_, record.input.known()),
        place_(static_cast<Eigen::Index>(effect.place)),
        fine_(effect.what.rough || effect.what.memory > 0 ? kFineRough : kFineSmooth),
        unit_(unit),
        in_series_(model.has(Acts::series)) {}

  /// False where the model can't be computed, or moves in no way that a law could take up.
  bool prepare(const JointModel& model) {
    const auto predicted = predict(record_, model, values_, true);
    if (!path_.matrices() || !predicted || predicted->flow.cols() <= place_ || !predicted->output.allFinite()) return false;
    const auto prediction = Prediction::make(record_.input, model, values_);
    if (!prediction) return false;
    const PlantMatrices& p = *path_.matrices();
    steps_.emplace(p, place_, step_s());
    gain_ = kSpread * std::max(-((p.Cf.row(place_) * p.E.col(place_))(0) * step_s() + p.Ff(place_, place_)), 0.0);
    for (const Layout::Segment& s : record_.layout.segments)
      if (!add_piece(s, *predicted, *prediction)) return false;
    return true;
  }

  Eigen::VectorXd change(const JointModel& model, const Eigen::VectorXd& values) const override {
    const Addition& law = model.additions.back();
    const double* p = model.values_of(model.additions.size() - 1, values);
    Eigen::VectorXd rows(record_.layout.rows);
    Eigen::Index row = 0;
    for (const Piece& piece : pieces_) {
      Eigen::VectorXd output = output_by(law, p, piece);
      if (in_series_ && output.allFinite())
        output = filtered(output, sample_time_s(), 1, Beyond::mirrored, [this](double f) { return path_.series(s_at(f)); });
      output -= piece.by_state * (piece.from_window * output.head(piece.where.window));
      for (Eigen::Index i = 0; i < piece.where.rows; ++i)
        rows[row++] = -output[piece.where.first_row - piece.where.samples.first + i * record_.layout.stride] / unit_;
    }
    return rows;
  }

 private:
  double sample_time_s() const { return record_.input.sample_time_s(); }
  double step_s() const { return sample_time_s() / fine_; }

  bool add_piece(const Layout::Segment& s, const Predicted& predicted, const Prediction& prediction) {
    const Stretch& at = s.samples;
    Piece piece;
    piece.where = s;
    const Eigen::VectorXd left = record_.output.segment(at.first, at.count) - predicted.output.segment(at.first, at.count);
    Eigen::VectorXd flow = predicted.flow.col(place_).segment(at.first, at.count),
                    stored = predicted.stored.col(place_).segment(at.first, at.count);
    move_as_measured(left, flow, stored);
    piece.flow = interpolated(flow, fine_);
    piece.stored = interpolated(stored, fine_);
    piece.by_state = prediction.free_response(at.count);
    const Eigen::MatrixXd window = piece.by_state.topRows(s.window);
    const Eigen::VectorXd size = window.colwise().norm().transpose().cwiseMax(1e-300);
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(kWeak);
    solver.compute(window * size.cwiseInverse().asDiagonal());
    piece.from_window = size.cwiseInverse().asDiagonal() * solver.pseudoInverse();
    const bool sound = piece.flow.allFinite() && piece.stored.allFinite() && piece.from_window.allFinite();
    pieces_.push_back(std::move(piece));
    return sound;
  }

  /// Adds to the model's motion what the reaction would move that makes what is left.
  void move_as_measured(const Eigen::VectorXd& left, Eigen::VectorXd& flow, Eigen::VectorXd& stored) const {
    const Eigen::Index n = left.size();
    const Stretches whole = {{0, n}};
    const NoiseModel noise = fit_noise(left, whole, noise_order(left, whole, kNoiseOrder));
    Eigen::VectorXd mirrored(2 * n);
    mirrored << left, left.reverse();
    const Eigen::VectorXcd lines = numerics::half_dft(mirrored);
    // A line of mirrored white noise has twice as many squares as samples.
    const double floor = 2.0 * static_cast<double>(n) * noise.variance, stands_out = std::log(static_cast<double>(n) / kChance);
    Eigen::VectorXcd more_flow = Eigen::VectorXcd::Zero(2 * n), more_stored = more_flow;
    for (Eigen::Index k = 1; k < n; ++k) {
      const double power = std::norm(lines[k]) / floor;
      if (!(power > stands_out)) continue;
      const MovedByOutput moved =
          moved_at(path_, place_, s_at(static_cast<double>(k) / (2.0 * static_cast<double>(n) * sample_time_s())));
      if (!finite(moved.flow) || !finite(moved.stored)) continue;
      const Complex shown = lines[k] * (1.0 - 1.0 / power);
      more_flow[k] = moved.flow * shown;
      more_stored[k] = moved.stored * shown;
      more_flow[2 * n - k] = std::conj(more_flow[k]);
      more_stored[2 * n - k] = std::conj(more_stored[k]);
    }
    flow += numerics::inverse_dft(more_flow).real().head(n);
    stored += numerics::inverse_dft(more_stored).real().head(n);
  }

  Eigen::VectorXd output_by(const Addition& law, const double* p, const Piece& piece) const {
    std::vector<double> memory(law.what.memory + 1, 0.0), next = memory;
    const double start_s = static_cast<double>(piece.where.samples.first) * sample_time_s();
    const auto react = [&](Eigen::Index n) {
      const double time_s = start_s + static_cast<double>(n) * step_s();
      const Reaction r =
          law.effect->react(p, {piece.flow[n], piece.stored[n], time_s, step_s(), gain_}, memory.data(), next.data());
      memory.swap(next);
      return r.value;
    };
    const Steps& s = *steps_;
    const Eigen::Index states = s.phi.rows();
    Eigen::VectorXd output(piece.where.samples.count), x = Eigen::VectorXd::Zero(states), moved(states);
    double before = 0.0;
    for (Eigen::Index n = 0; n < piece.flow.size(); ++n) {
      const double here = react(n);
      if (n > 0) {
        moved.noalias() = s.phi * x;
        x = moved + s.from * before + s.to * here;
      }
      if (n % fine_ == 0) output[n / fine_] = s.output.dot(x) + s.direct * here;
      before = here;
    }
    return output;
  }

  const SampledRecord& record_;
  const Eigen::VectorXd values_;  ///< of the model without the effect
  LinearPath path_;
  Eigen::Index place_;
  int fine_;
  double unit_;
  bool in_series_;
  double gain_ = 0.0;
  std::optional<Steps> steps_;
  std::vector<Piece> pieces_;
};

}  // namespace

std::unique_ptr<const OpenLoop> sampled_open_loop(const SampledRecord& record, const JointModel& model,
                                                  const Eigen::VectorXd& values, const Addition& effect, double unit) {
  if (effect.what.acts != Acts::law || !model.base->has_state_space()) return nullptr;
  LinearPlant plant;
  if (!model.base->state_space(values.data(), record.input.known().data(), plant) || plant.states == 0) return nullptr;
  auto look = std::make_unique<LawLook>(record, model, values, effect, unit);
  if (!look->prepare(model)) return nullptr;
  return look;
}

}  // namespace bodeflow::residual
