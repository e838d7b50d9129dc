#pragma once

/// First-order low pass, the exact discretisation of 1 / (1 + s / (2 pi f_c)) for inputs held constant between samples:
/// y[n] = y[n-1] + a (x[n] - y[n-1]) with a = 1 - exp(-2 pi f_c / f_s). It knows no ports, clocks or logs: a test calls it.
class LowPass {
 public:
  /// Both above zero, in hertz.
  LowPass(double corner_hz, double rate_hz);

  /// The next output sample.
  double step(double x) {
    y_ += a_ * (x - y_);
    return y_;
  }
  /// Another corner frequency; the output goes on from where it is.
  void set_corner(double corner_hz);
  /// Back to rest.
  void reset() { y_ = 0.0; }

 private:
  double rate_hz_;
  double a_ = 0.0;
  double y_ = 0.0;
};
