#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "trace/measurement.hpp"

/// A plant, effects and measurements that are linear in what is to be found, so that every statistic is known.
namespace bodeflow::residual::test {

/// y(n) = v0 sin(0.9 n) + v1 cos(0.35 n), times the level of the record.
class FakeBase final : public BaseModel {
 public:
  explicit FakeBase(std::vector<Place> places = {}) : places_(std::move(places)) {}
  std::vector<FitParameter> parameters() const override;
  std::vector<Place> places() const override { return places_; }
  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse>) const override { return {{1.5, 0.7}}; }
  bool response(const double* v, const double*, std::complex<double> s, std::complex<double>* matrix) const override;

 private:
  std::vector<Place> places_;
};

/// p times shape(n, level, others), said to act in parallel.
struct FakeLaw {
  std::string name;
  std::vector<FitParameter> parameters;
  std::vector<std::vector<double>> starts;
  std::function<double(const double* p, double n, double level)> value;
  std::vector<std::string> equivalents = {};
  std::string refusal = {};
};
CatalogueEntry fake_effect(const FakeLaw& law);
/// An effect a * shape(n) that may not be negative.
CatalogueEntry one_sided(const std::string& name, std::function<double(double n, double level)> shape);

/// Gaussian noise of unit variance on n = 0 .. rows - 1.
struct FakeRecord {
  std::string name = "fit 1";
  Eigen::Index rows = 300;
  double level = 1.0;
  double noise = 1.0;
  std::uint64_t seed = 1;
  bool floor_known = true;
  double sample_rate_hz = 100.0;
  std::string unit = "A";
};
/// Measures the base (v0 = 2, v1 = 1) with these truths added.
std::shared_ptr<const Measurement> measure(const FakeRecord& record,
                                           const std::function<double(double n, double level)>& hidden = {});

}  // namespace bodeflow::residual::test
