#include "iio_block.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/sampling.hpp"

namespace bodeflow::acquisition {
namespace {

// A driver that rounds the rate to what its clock divides into is told; below this it is the rounding of a text.
constexpr double kSameRate = 1e-6;
// A step between two time stamps of more than so many intervals is a loss.
constexpr double kLoss = 1.5;

// Samples are handed over so often, for a run that can be followed and ended.
constexpr double kUsual_s = 0.05;
constexpr double kMostUsual = 4096;

std::size_t usual_buffer(double rate_hz) {
  return static_cast<std::size_t>(std::clamp(std::round(kUsual_s * rate_hz), 1.0, kMostUsual));
}

void describe_connection(Describe& d) {
  d.parameter("uri", "local:").doc("`local:`, `ip:HOST`, `ip:HOST:PORT`, `usb:...`, `serial:...`; `iio_info -s` finds devices");
  d.required<std::string>("device").doc("the device's name, label or id, such as ad7606 or iio:device0");
  d.required<std::vector<std::string>>("channels").doc("ids of its channels, such as [voltage0, voltage1]");
  d.required<double>("rate").unit("Hz").above(0.0).doc(
      "samples per second: written to `sampling_frequency` of the device or its first channel, and compared with what that reads "
      "then");
  d.parameter("attributes", std::vector<std::string>{})
      .doc("written before the capture begins: name=value, or channel/name=value");
  d.optional<std::string>("trigger").doc("name or id of the trigger that starts each conversion");
  d.optional<std::int64_t>("buffer")
      .range(1, 1 << 24)
      .doc("samples that the device hands over at once; without it those of 50 ms, at most 4096");
  d.parameter("kernel_buffers", std::int64_t{8}).range(1, 1024).doc("of these, which the kernel fills while none is read");
  d.parameter("timeout", 2.0).unit("s").range(0.05, 60).doc("a device that gives nothing for so long ends the run");
  d.parameter("timestamps", false)
      .doc(
          "reads the device's channel `timestamp` too: a step of more than 1.5 intervals is a loss. For devices that stamp by "
          "hardware; "
          "without it samples that the kernel dropped can't be seen");
  d.optional<std::string>("clock").doc("clock domain of the device; `iio:`, the address and the device's name without it");
}

/// The unit of the reading where nothing was made of it, else "".
std::string unit_given(const ScaleSettings& s, const Parameters& p, const IioQuantity& quantity) {
  return p.given("unit") || p.given("scale") || !s.calibration.empty() ? "" : quantity.unit;
}

}  // namespace

void IioCapture::describe(Describe& d) {
  d.id("acquisition.iio")
      .summary("Takes samples from a device of Linux IIO, on this machine or over a network.")
      .role("source")
      .role("device")
      .cost_ns(200);
  d.doc(
      "Buffered capture through libiio. A reading is (raw + offset) scale by the channel's attributes, in SI units by its kind: "
      "voltage in V, current in A, accel in m/s^2, anglvel in rad/s, temp in K and so on; other kinds have no unit. `scale` or "
      "`calibration` makes of it what a transducer before the converter measures. Blocks until the device has given the samples "
      "of a "
      "call; it paces the run. Losses that the time stamps show end the run or are marked (`on_gap`); the samples behind one "
      "follow "
      "directly.");
  d.reference("Linux kernel, Documentation/ABI/testing/sysfs-bus-iio");
  d.stream_out(out).doc("the channels, on the device's own clock");
  describe_device_ports(d, device, gaps);
  describe_connection(d);
  describe_on_gap(d);
  describe_scale(d, "", "one unit of the reading");
}

void IioCapture::configure(const Parameters& p) {
  spec_.uri = p.text("uri");
  spec_.device = p.text("device");
  spec_.channels = p.texts("channels");
  if (spec_.channels.empty()) fail("channels is empty; allowed: ids of channels such as [voltage0]");
  for (const std::string& text : p.texts("attributes")) {
    auto attribute = iio_attribute(text);
    if (!attribute) fail(attribute.error().text);
    spec_.attributes.push_back(std::move(*attribute));
  }
  if (p.has("trigger")) spec_.trigger = p.text("trigger");
  spec_.rate_hz = p.number("rate");
  spec_.buffer = p.has("buffer") ? static_cast<std::size_t>(p.integer("buffer")) : usual_buffer(spec_.rate_hz);
  spec_.kernel_buffers = static_cast<unsigned>(p.integer("kernel_buffers"));
  spec_.timeout_s = p.number("timeout");
  if (static_cast<double>(spec_.buffer) / spec_.rate_hz >= spec_.timeout_s)
    fail("a buffer of " + std::to_string(spec_.buffer) + " samples comes every " +
         short_text(static_cast<double>(spec_.buffer) / spec_.rate_hz) + " s, the timeout is " + short_text(spec_.timeout_s) +
         " s; lower buffer or raise timeout");
  spec_.timestamps = p.boolean("timestamps");
  clock_name_ = p.has("clock") ? p.text("clock") : "iio:" + spec_.uri + "/" + spec_.device;
  mark_gaps_ = p.text("on_gap") == "mark";
  rate_ = Rate::from_hz(spec_.rate_hz);
  if (!rate_.known()) fail("rate " + number_text(spec_.rate_hz) + " Hz is beyond what can be kept as a fraction");
  const ScaleSettings scale = read_scale(p, "");
  channels_ = make_channels(scale, spec_.channels);
  if (!scale.calibration.empty()) note_input(scale.calibration);
  quantities_.clear();
  for (std::size_t c = 0; c < spec_.channels.size(); ++c) {
    quantities_.push_back(iio_quantity(spec_.channels[c]));
    if (const std::string unit = unit_given(scale, p, quantities_[c]); !unit.empty()) channels_.scales[c].unit = unit;
  }
}

void IioCapture::resolve(Facts& f) {
  StreamFacts& y = f.out(out);
  y.known = true;
  y.rate = rate_;
  y.clock = clock_name_;
  channels_.state(y);
}

void IioCapture::activate(const Activation& a) {
  require_realtime(a);
  if (const std::string advice = advice_on_calls(a); !advice.empty()) log_warning(advice);
  auto opened = IioSession::open(spec_);
  if (!opened) fail(opened.error().text);
  session_.emplace(std::move(*opened));
  check_rate();
  reset();
}

void IioCapture::check_rate() const {
  const std::optional<double> found = session_->rate_hz();
  if (!found) {
    log_warning("the device has no attribute sampling_frequency: its rate is taken to be " + number_text(spec_.rate_hz) +
                " Hz; compare with the measured rate at the end");
  } else if (std::abs(*found - spec_.rate_hz) > kSameRate * spec_.rate_hz) {
    fail("IIO device '" + spec_.device + "' runs at " + number_text(*found) + " Hz where " + number_text(spec_.rate_hz) +
         " Hz were asked for; set rate to that, or to another rate that it has");
  }
}

void IioCapture::reset() {
  running_ = false;
  filled_ = taken_ = 0;
  received_ = 0;
  stamp_ns_.reset();
  clock_.reset();
  report_ = DeviceReport();
  report_.device = spec_.device;
  report_.clock = clock_name_;
  report_.rate_hz = rate_.hz();
  report_.buffer = static_cast<std::int64_t>(spec_.buffer);
  if (session_) session_->stop();
}

void IioCapture::refill() {
  if (!running_) {
    if (auto done = session_->start(); !done) fail(done.error().text);
    running_ = true;
  }
  const auto samples = session_->refill();
  if (!samples) fail(samples.error().text);
  filled_ = *samples;
  taken_ = 0;
  received_ += static_cast<std::int64_t>(filled_);
  clock_.add({received_, monotonic_s()});
}

/// Samples of the buffer at hand before the next one that follows a loss, `most` at most.
std::size_t IioCapture::until_gap(std::size_t most) const {
  if (!spec_.timestamps) return most;
  const double longest_ns = kLoss * 1e9 / rate_.hz();
  std::optional<std::int64_t> before = stamp_ns_;
  for (std::size_t n = 0; n < most; ++n) {
    const std::int64_t now = session_->timestamp(taken_ + n);
    if (before && static_cast<double>(now - *before) > longest_ns) return n;
    before = now;
  }
  return most;
}

void IioCapture::mark(std::size_t offset, Io& io) {
  Gap gap;
  gap.position = static_cast<std::int64_t>(io.position() + offset);
  gap.cause = GapCause::loss;
  gap.missing = std::llround(static_cast<double>(session_->timestamp(taken_) - *stamp_ns_) * 1e-9 * rate_.hz()) - 1;
  if (!mark_gaps_)
    fail(text_of(gap) + ": by the device's time stamps; raise buffer or kernel_buffers, or set on_gap: mark to go on");
  report_.count(gap);
  log_warning(text_of(gap));
  io.emit(gaps, gap_record(gap), offset);
  stamp_ns_.reset();
}

void IioCapture::process(Io& io) {
  for (std::size_t done = 0; done < io.count();) {
    if (taken_ == filled_) refill();
    const std::size_t wanted = std::min(io.count() - done, filled_ - taken_);
    const std::size_t count = until_gap(wanted);
    for (std::size_t c = 0; c < channels_.scales.size(); ++c) {
      const auto values = io.write(out, static_cast<int>(c)).subspan(done, count);
      session_->read(c, taken_, values);
      const ChannelScale& scale = channels_.scales[c];
      const IioQuantity& quantity = quantities_[c];
      for (double& x : values) x = scale.gain * (quantity.factor * x + quantity.zero) + scale.offset;
    }
    taken_ += count;
    done += count;
    if (spec_.timestamps && count > 0) stamp_ns_ = session_->timestamp(taken_ - 1);
    if (count < wanted) mark(done, io);
  }
  report_.samples += static_cast<std::int64_t>(io.count());
}

void IioCapture::finish(Io& io) {
  if (session_) session_->stop();
  const auto rate = clock_.rate_hz();
  log_info(report_.gaps_text() + (rate ? "; " + short_text(*rate) + " Hz by the clock of this machine" : ""));
  io.emit(device, device_record(report_, clock_));
}

void IioCapture::deactivate() { session_.reset(); }

}  // namespace bodeflow::acquisition
