#include "evaluation_block.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "block_settings.hpp"
#include "numbers_in_text.hpp"

namespace bodeflow::adaptive_control {
namespace {

constexpr int kCurvePoints = 200;
constexpr std::size_t kMostActions = 500;  // of safety nets that a record holds

template <class T>
void append(std::vector<T>& to, std::span<const T> from) {
  to.insert(to.end(), from.begin(), from.end());
}

void put(RecordBuilder& r, const char* name, const std::string& unit, const std::vector<double>& values) {
  if (values.empty()) return;
  const auto to = r.array<double>(name, unit, {values.size()});
  std::copy(values.begin(), values.end(), to.begin());
}

}  // namespace

void Evaluation::describe(Describe& d) {
  d.id("adaptive_control.evaluation")
      .summary("Collects an adaptive run: its signals, estimates and controllers, and its tracking error.");
  d.doc(
      "The record `adaptive_run` holds all samples; `bodeflow report` draws them as the figures of the thesis: command and "
      "output, control signal, Nyquist curve with the estimates, controllers over time. rms is that of y - desired in the "
      "windows. With the plant given, the error of the estimates is told as well; with the logs of estimator and design, what "
      "their "
      "safety nets did and why. Keeps all samples in memory: for runs of up to some million.");
  d.parameter("windows", std::vector<double>{}).unit("s").doc("times; the tracking error is given from each to the next");
  d.parameter("start", 0.0).unit("s").range(0, 1e12).doc("largest |u| and overshoot are counted from here on");
  d.parameter("frequencies", std::vector<double>{}).unit("rad/s").doc("of the estimates at `response`");
  describe_plant(d, false);
  d.stream_in(command).doc("set point");
  d.stream_in(y).doc("output of the plant");
  d.stream_in(u).doc("limited control signal");
  d.stream_in(desired).optional().doc("output of adaptive_control.reference_model");
  d.stream_in(response).optional().doc("estimates");
  d.stream_in(coefficients).optional().doc("controllers");
  d.stream_in(beside).optional().doc("output of another loop on the same plant, drawn beside");
  d.message_in(estimator_log).optional().record_type("net_action").doc("safety nets of the estimator, for the list of them");
  d.message_in(design_log).optional().record_type("net_action").doc("safety nets of the design, for the list of them");
  d.message_out(result).record_type("adaptive_run");
}

void Evaluation::configure(const Parameters& p) {
  windows_s_ = p.numbers("windows");
  if (!std::is_sorted(windows_s_.begin(), windows_s_.end())) fail("windows: the times do not rise");
  from_s_ = p.number("start");
  omega_ = p.numbers("frequencies");
  if (has_plant(p)) plant_ = read_plant(p);
  delay_s_ = p.number("plant.delay");
}

void Evaluation::resolve(Facts& f) {
  for (const In<double>& input : {command, y, u, desired, beside}) {
    if (f.in(input).known && f.in(input).channels != 1) fail(std::string("'") + input.name + "' needs one channel");
  }
  if (f.in(response).known && static_cast<std::size_t>(f.in(response).channels) != omega_.size()) {
    fail("'response' has " + std::to_string(f.in(response).channels) + " channels, `frequencies` " +
         std::to_string(omega_.size()) + "; allowed: the same");
  }
  coefficient_names_ = f.in(coefficients).channel_names;
}

void Evaluation::activate(const Activation& a) {
  sample_time_ = 1.0 / a.rate.hz();
  reset();
}

void Evaluation::reset() {
  command_.clear(), y_.clear(), u_.clear(), desired_.clear(), beside_.clear();
  response_.assign(omega_.size(), {});
  coefficients_.assign(coefficient_names_.size(), {});
  actions_.clear();
  more_actions_ = 0;
}

void Evaluation::process(Io& io) {
  append(command_, io.read(command));
  append(y_, io.read(y));
  append(u_, io.read(u));
  if (io.connected(desired)) append(desired_, io.read(desired));
  if (io.connected(beside)) append(beside_, io.read(beside));
  for (int j = 0; j < io.channels(response); ++j) append(response_[static_cast<std::size_t>(j)], io.read(response, j));
  for (std::size_t c = 0; c < coefficients_.size() && io.connected(coefficients); ++c) {
    append(coefficients_[c], io.read(coefficients, static_cast<int>(c)));
  }
}

void Evaluation::receive(int, const RecordView& record, Io&) {
  if (record.type() != "net_action") fail("a record '" + std::string(record.type()) + "'; needed: net_action");
  if (actions_.size() == kMostActions) {
    ++more_actions_;
    return;
  }
  const auto text = [&](const char* name) { return std::string(record.text(name).value_or("")); };
  const bool begins = text("action") == "begins";
  std::string told = text("net") + " " + text("action");
  if (const auto omega = record.number("frequency")) told += " at " + text_of(*omega) + " rad/s";
  if (begins) told += ": " + text("cause");
  const auto value = record.number("value"), limit = record.number("limit");
  if (begins && value && limit) told += " (" + text_of(*value) + ", limit " + text_of(*limit) + ")";
  actions_.push_back({record.number("sample").value_or(0.0), told});
}

void Evaluation::add_actions(RecordBuilder& r) {
  if (actions_.empty()) return;
  std::stable_sort(actions_.begin(), actions_.end(), [](const Action& a, const Action& b) { return a.sample < b.sample; });
  std::vector<std::string> texts;
  std::vector<double> times;
  for (const Action& action : actions_) {
    texts.push_back(action.text);
    times.push_back(action.sample * sample_time_);
  }
  r.set("net_actions", texts);
  put(r, "net_action_time", "s", times);
  if (more_actions_ > 0) r.set("more_net_actions", more_actions_);
}

double Evaluation::rms(std::size_t from, std::size_t to) const {
  double sum = 0.0;
  for (std::size_t n = from; n < to; ++n) sum += (y_[n] - desired_[n]) * (y_[n] - desired_[n]);
  return std::sqrt(sum / static_cast<double>(to - from));
}

void Evaluation::add_windows(RecordBuilder& r) const {
  std::vector<double> errors;
  for (std::size_t i = 0; i + 1 < windows_s_.size() && !desired_.empty(); ++i) {
    const auto at = [&](double time) {
      return std::min(y_.size(), static_cast<std::size_t>(std::max(0.0, std::ceil(time / sample_time_ - 1e-9))));
    };
    const std::size_t from = at(windows_s_[i]), to = at(windows_s_[i + 1]);
    if (to > from) errors.push_back(rms(from, to));
  }
  if (!errors.empty()) {
    r.set("windows", windows_s_);
    r.set("rms_in_windows", errors);
  }
  if (!desired_.empty() && !y_.empty()) r.set("rms", rms(0, y_.size()));
}

void Evaluation::add_truth(RecordBuilder& r) const {
  if (!plant_) return;
  std::vector<double> curve;
  for (int i = 0; i < kCurvePoints; ++i)
    curve.push_back(std::numbers::pi / sample_time_ * std::pow(1e-2, 1.0 - (i + 1.0) / kCurvePoints));
  curve.back() *= 1.0 - 1e-9;
  const auto truth = value_or_fail(sampled_response(*plant_, delay_s_, sample_time_, curve));
  put(r, "curve_frequency", "rad/s", curve);
  const auto to = r.array<std::complex<double>>("curve", "", {truth.size()});
  std::copy(truth.begin(), truth.end(), to.begin());
  if (omega_.empty() || y_.empty() || response_[0].empty()) return;
  const auto points = value_or_fail(sampled_response(*plant_, delay_s_, sample_time_, omega_));
  std::vector<double> error;
  for (std::size_t j = 0; j < omega_.size(); ++j) error.push_back(std::abs(response_[j].back() / points[j] - 1.0));
  r.set("relative_error_of_estimates", error);
}

void Evaluation::finish(Io& io) {
  RecordBuilder r("adaptive_run");
  r.set("sample_time", sample_time_);
  r.set("samples", static_cast<std::int64_t>(y_.size()));
  add_windows(r);
  const auto first = std::min(y_.size(), static_cast<std::size_t>(std::ceil(from_s_ / sample_time_ - 1e-9)));
  double largest = 0.0;
  for (std::size_t n = first; n < u_.size(); ++n) largest = std::max(largest, std::abs(u_[n]));
  r.set("largest_control", largest);
  put(r, "command", "", command_);
  put(r, "output", "", y_);
  put(r, "control", "", u_);
  put(r, "desired", "", desired_);
  put(r, "beside", "", beside_);
  if (!omega_.empty() && !response_[0].empty()) {
    put(r, "frequencies", "rad/s", omega_);
    const auto to = r.array<std::complex<double>>("response", "", {omega_.size(), y_.size()});
    for (std::size_t j = 0; j < omega_.size(); ++j) {
      std::copy(response_[j].begin(), response_[j].end(), to.begin() + static_cast<std::ptrdiff_t>(j * y_.size()));
    }
  }
  if (!coefficients_.empty() && !coefficients_[0].empty()) {
    r.set("coefficient_names", coefficient_names_);
    const auto to = r.array<double>("coefficients", "", {coefficients_.size(), y_.size()});
    for (std::size_t c = 0; c < coefficients_.size(); ++c) {
      std::copy(coefficients_[c].begin(), coefficients_[c].end(), to.begin() + static_cast<std::ptrdiff_t>(c * y_.size()));
    }
  }
  add_truth(r);
  add_actions(r);
  io.emit(result, r);
}

}  // namespace bodeflow::adaptive_control
