#pragma once

#include <bodeflow/numerics/narrow_band_pass.hpp>
#include <complex>
#include <cstdint>

#include "desired_response.hpp"
#include "least_squares.hpp"
#include "net_log.hpp"

namespace bodeflow::adaptive_control {

/// How the parameters of a low-order model are estimated.
enum class Method {
  least_squares,  ///< recursive least squares with exponential forgetting, U D factors
  directional,    ///< forgetting only along new data; biased on narrow-band signals (4.2)
  extended,       ///< extended least squares: the noise as a moving average, with `noise_terms` terms
  instrumental,   ///< instrumental variables, delayed samples of the filtered reference as instruments
};

/// One frequency point estimator.
struct FrequencyPointSettings {
  double omega = 0.0;        ///< [rad/s]
  double sample_time = 1.0;  ///< h [s]
  int denominator = 2;       ///< n_a, 0 to 2
  int numerator = 1;         ///< n_b, 1 to 3; n_a + n_b >= 2
  int noise_terms = 0;       ///< n_c of Method::extended, 1 to 3
  int delay = 0;             ///< d samples: the model's first response is at sample d + 1
  Method method = Method::least_squares;
  double p0 = 1e6;          ///< P(0) = (omega h)^2 p0 I
  double forgetting = 1.0;  ///< lambda
  double filter_radius = 0.9;
  int filter_sections = 2;
  double filter_spread = 2.0 * 3.14159265358979323846 / 180.0;  ///< [rad] between neighbouring poles
  int warm_up = 0;                                              ///< updates before an estimate is handed on
  bool gate = true, bound = true, huber = true;
};

inline constexpr int kMostDelay = 64;

/// Estimates one point G(exp(i omega h)) of a plant's frequency response while it runs.
///
/// Method: sections 4.2 and 4.3 of Kallen 1992. Input and output pass the same narrow band-pass filter; a low-order model
///   y_f(t) = -a_1 y_f(t-1) - .. + b_1 u_f(t-d-1) + b_2 u_f(t-d-2) + ..
/// is fitted recursively and evaluated at the centre frequency. Two parameters are biased by several per cent (4.4), three are
/// not. Signals should be of the size 1: p0 has units. Noise that is not white in the equation biases least squares; the variance
/// does not tell of that. Safety nets: no update while the excitation of the band is below its floor; D <= P(0); a residual
/// beyond 3 sigma counts as 3 sigma (Huber), which keeps load disturbances out.
class FrequencyPoint {
 public:
  /// Errors: a structure outside the stated ranges, a delay outside 0 .. kMostDelay, lambda outside (0, 1], p0 not above 0, and
  /// what the filter refuses (a frequency too near zero or the Nyquist frequency).
  static Expected<FrequencyPoint> make(const FrequencyPointSettings& settings);

  struct Sample {
    double y = 0.0;                 ///< y(k)
    double u_late = 0.0;            ///< the limited control signal u_l(k-1)
    double reference = 0.0;         ///< u_c(k), for instruments
    double least_excitation = 0.0;  ///< E_min
  };
  /// Takes sample k. Allocates nothing.
  void step(const Sample& sample);

  /// The estimate; 0 until `warm_up` updates were made.
  std::complex<double> response() const { return updates_ >= settings_.warm_up ? response_ : 0.0; }
  /// E |estimate - its mean|^2 predicted from P, the residuals and the correlation that the filter gives them; 0 before the first
  /// update. Good to a factor of about 2 while the command excites the band evenly and noise outweighs what the
  /// low-order model leaves (else it is too large); too small for extended least squares, which take the noise model as known.
  /// Cost: 10^4 to 10^6 operations, and it allocates: not for every sample.
  double variance() const;
  const Regressor& parameters() const { return directional_or_iv() ? full_.theta() : ud_.theta(); }
  double excitation() const { return excitation_; }
  std::int64_t updates() const { return updates_; }

  /// Whether a net acts at the sample of the last step.
  struct Acting {
    bool gate = false, bound = false, huber = false;
    double residual = 0.0, residual_limit = 0.0;
  };
  const Acting& acting() const { return acting_; }

 private:
  explicit FrequencyPoint(const FrequencyPointSettings& settings, const numerics::NarrowBandPass& filter);

  bool directional_or_iv() const { return settings_.method == Method::directional || settings_.method == Method::instrumental; }
  int parameter_count() const {
    return settings_.denominator + settings_.numerator + (settings_.method == Method::extended ? settings_.noise_terms : 0);
  }
  Regressor regressor() const;
  void update(double y_f);
  double clipped(double error, double scale);
  void evaluate();
  double shared_correlation() const;

  FrequencyPointSettings settings_;
  numerics::NarrowBandPass filter_y_, filter_u_, filter_reference_;
  UdLeastSquares ud_;
  FullLeastSquares full_;
  std::array<std::complex<double>, 4> z_back_{};  // z^-i
  std::complex<double> z_delay_;                  // z^-d

  std::array<double, 4> y_past_{}, noise_past_{};  // y_f(k-1) .. , residuals of the extended model
  std::array<double, kMostDelay + 8> u_past_{};    // ring of u_f
  std::array<double, 4 * kMostParameters> reference_past_{};
  std::size_t instrument_step_ = 1;  // samples between instruments: 2 rad, 4 samples at most
  std::size_t newest_u_ = 0;
  double excitation_ = 0.0, y_power_ = 0.0, sigma_squared_ = 0.0, weight_sum_ = 0.0, weight_squares_ = 0.0;
  std::int64_t updates_ = 0;
  std::complex<double> response_ = 0.0;
  Acting acting_;
};

}  // namespace bodeflow::adaptive_control
