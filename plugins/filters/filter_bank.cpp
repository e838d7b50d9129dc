#include "filter_bank.hpp"

#include <algorithm>
#include <cmath>
#include <new>

namespace bodeflow::filters {
namespace {

using numerics::Biquad;
using numerics::NarrowBandPass;
using numerics::Sections;

std::size_t sections_of(const BankFilter& f) {
  if (const auto* direct = std::get_if<Sections>(&f.filter)) return direct->size();
  return static_cast<std::size_t>(std::get<NarrowBandPass>(f.filter).sections());
}

void add_poles(std::vector<std::complex<double>>& poles, const Biquad& k) {
  const double half = -0.5 * k.a1, discriminant = half * half - k.a2;
  if (discriminant < 0) {
    poles.emplace_back(half, std::sqrt(-discriminant));
  } else {
    poles.emplace_back(half + std::sqrt(discriminant));
    poles.emplace_back(half - std::sqrt(discriminant));
  }
}

}  // namespace

std::complex<double> BankFilter::response(double w_h) const {
  if (const auto* direct = std::get_if<Sections>(&filter)) return numerics::response(*direct, w_h);
  return std::get<NarrowBandPass>(filter).response(w_h);
}

Eigen::VectorXd BankFilter::impulse_response(std::size_t count) const {
  if (const auto* direct = std::get_if<Sections>(&filter)) {
    return numerics::impulse_response(*direct, static_cast<Eigen::Index>(count));
  }
  NarrowBandPass rotations = std::get<NarrowBandPass>(filter);
  rotations.reset();
  Eigen::VectorXd h(static_cast<Eigen::Index>(count));
  for (Eigen::Index n = 0; n < h.size(); ++n) h[n] = rotations.step(n == 0 ? 1.0 : 0.0);
  return h;
}

std::vector<std::complex<double>> BankFilter::poles() const {
  std::vector<std::complex<double>> poles;
  if (const auto* direct = std::get_if<Sections>(&filter)) {
    for (const Biquad& k : *direct) add_poles(poles, k);
    return poles;
  }
  const auto& rotations = std::get<NarrowBandPass>(filter);
  for (int i = 0; i < rotations.sections(); ++i) poles.push_back(std::polar(rotations.radius(), rotations.section(i).phi));
  return poles;
}

FilterBank::Memory FilterBank::zeros(std::size_t count) {
  auto* memory = static_cast<double*>(std::aligned_alloc(64, sizeof(double) * std::max<std::size_t>(count, kLanes)));
  if (memory == nullptr) throw std::bad_alloc();
  std::fill_n(memory, count, 0.0);
  return Memory(memory);
}

FilterBank::FilterBank(const std::vector<BankFilter>& filters, std::size_t channels)
    : filters_(filters.size()), lanes_(filters.size() * channels) {
  for (const BankFilter& f : filters) sections_ = std::max(sections_, sections_of(f));
  rotations_ = !filters.empty() && std::holds_alternative<NarrowBandPass>(filters.front().filter);
  coefficients_in_section_ = rotations_ ? 6 : 5;
  const std::size_t groups = (lanes_ + kLanes - 1) / kLanes;
  coefficients_ = zeros(groups * sections_ * coefficients_in_section_ * kLanes);
  state_count_ = groups * sections_ * 2 * kLanes;
  states_ = zeros(state_count_);
  inputs_.resize(lanes_);
  for (std::size_t lane = 0; lane < lanes_; ++lane) place(filters[lane % filters_], lane);
}

// Sections that a shorter filter lacks let everything through: y = 1 x + 0.
void FilterBank::place(const BankFilter& f, std::size_t lane) {
  const auto put = [&](std::size_t section, std::initializer_list<double> values) {
    const std::size_t first = ((lane / kLanes) * sections_ + section) * coefficients_in_section_;
    std::size_t i = 0;
    for (const double value : values) coefficients_[(first + i++) * kLanes + lane % kLanes] = value;
  };
  for (std::size_t i = 0; i < sections_; ++i) {
    if (i >= sections_of(f)) {
      rotations_ ? put(i, {0, 0, 0, 0, 0, 1}) : put(i, {1, 0, 0, 0, 0});
    } else if (rotations_) {
      const NarrowBandPass::Section& s = std::get<NarrowBandPass>(f.filter).section(static_cast<int>(i));
      put(i, {s.cosine, s.sine, s.input, s.first, s.second, s.direct});
    } else {
      const Biquad& k = std::get<Sections>(f.filter)[i];
      put(i, {k.b0, k.b1, k.b2, k.a1, k.a2});
    }
  }
}

std::optional<std::size_t> FilterBank::run(const double* const* x, double* const* y, std::size_t count, int vector_level) {
  for (std::size_t lane = 0; lane < lanes_; ++lane) inputs_[lane] = x[lane / filters_];
  const Cascade cascade{coefficients_.get(), states_.get(), sections_, lanes_, inputs_.data(), y, lanes_ == filters_};
  const bool finite =
      rotations_ ? run_rotations(cascade, count, position_, vector_level) : run_direct(cascade, count, position_, vector_level);
  position_ += count;
  if (finite) return std::nullopt;
  for (std::size_t i = 0; i < state_count_; ++i) {
    const std::size_t lane = i / (sections_ * 2 * kLanes) * kLanes + i % kLanes;
    if (!std::isfinite(states_[i])) return std::min(lane, lanes_ - 1) / filters_;
  }
  return 0;
}

void FilterBank::reset() {
  std::fill_n(states_.get(), state_count_, 0.0);
  position_ = 0;
}

}  // namespace bodeflow::filters
