#include "session.hpp"

#include <iio.h>

#include <cerrno>
#include <cstring>

#include "acquisition/device/device_clock.hpp"
#include "acquisition/sampling.hpp"
#include "pipe_guard.hpp"

namespace bodeflow::acquisition {
namespace {

// A wait that lasted so much of the timeout ended by it.
constexpr double kOfTimeout = 0.95;

template <class Name>
std::string list(unsigned count, Name&& name) {
  std::string text;
  for (unsigned i = 0; i < count; ++i)
    if (const char* one = name(i); one != nullptr) text += (text.empty() ? "" : ", ") + std::string(one);
  return text.empty() ? "none" : text;
}

/// Name, or id where it has none.
const char* shown_name(const iio_device* device) {
  const char* name = iio_device_get_name(device);
  return name != nullptr ? name : iio_device_get_id(device);
}

}  // namespace

void IioSession::CloseContext::operator()(iio_context* context) const {
  const PipeGuard guard;
  iio_context_destroy(context);
}

void IioSession::CloseBuffer::operator()(iio_buffer* buffer) const {
  const PipeGuard guard;
  iio_buffer_destroy(buffer);
}

Unexpected<Error> IioSession::refused(const std::string& what) const {
  return unexpected("IIO device '" + spec_.device + "' at " + spec_.uri + ": " + what);
}

Expected<IioSession> IioSession::open(const IioSpec& spec) {
  const PipeGuard guard;
  IioSession made;
  made.spec_ = spec;
  errno = 0;
  std::string uri = spec.uri;  // libiio 0.24 writes into it
  made.context_.reset(iio_create_context_from_uri(uri.data()));
  if (!made.context_)
    return unexpected("no IIO at " + spec.uri + ": " + iio_error(errno) +
                      "; allowed: local:, ip:HOST, ip:HOST:PORT, usb:..., serial:...");
  for (const auto step :
       {&IioSession::find_device, &IioSession::write_attributes, &IioSession::find_channels, &IioSession::set_up})
    if (auto done = (made.*step)(); !done) return {Unexpected<Error>{done.error()}};
  return made;
}

Expected<void> IioSession::find_device() {
  const unsigned count = iio_context_get_devices_count(context_.get());
  device_ = iio_context_find_device(context_.get(), spec_.device.c_str());
  if (device_ != nullptr) return {};
  return unexpected("no IIO device '" + spec_.device + "' at " + spec_.uri + "; it has " +
                    list(count, [&](unsigned i) { return shown_name(iio_context_get_device(context_.get(), i)); }));
}

/// Before anything is read: a range changes the scales.
Expected<void> IioSession::write_attributes() {
  iio_context_set_timeout(context_.get(), static_cast<unsigned>(1e3 * spec_.timeout_s));
  for (const IioAttribute& attribute : spec_.attributes)
    if (auto done = write_attribute(device_, attribute); !done) return refused(done.error().text);
  return {};
}

Expected<void> IioSession::find_channels() {
  for (unsigned i = 0; i < iio_device_get_channels_count(device_); ++i) iio_channel_disable(iio_device_get_channel(device_, i));
  const auto scanned = [&](unsigned i) -> const char* {
    const iio_channel* c = iio_device_get_channel(device_, i);
    return iio_channel_is_scan_element(c) && !iio_channel_is_output(c) ? iio_channel_get_id(c) : nullptr;
  };
  std::vector<std::string> wanted = spec_.channels;
  if (spec_.timestamps) wanted.emplace_back("timestamp");
  for (const std::string& id : wanted) {
    iio_channel* channel = iio_device_find_channel(device_, id.c_str(), false);
    if (channel == nullptr || !iio_channel_is_scan_element(channel))
      return refused("no channel '" + id + "' that can be captured; it has " +
                     list(iio_device_get_channels_count(device_), scanned));
    if (id != iio_channel_get_id(channel))
      return refused("channel '" + id + "' has the id " + iio_channel_get_id(channel) +
                     "; name it by that, which tells its unit");
    if (iio_channel_get_data_format(channel)->length > 64 || iio_channel_get_data_format(channel)->repeat > 1)
      return refused("channel '" + id + "' gives more than one number a sample");
    iio_channel_enable(channel);
    if (spec_.timestamps && id == "timestamp") {
      timestamp_ = channel;
      continue;
    }
    Channel made;
    made.channel = channel;
    for (const auto& [name, value] : {std::pair{"scale", &made.scale}, {"offset", &made.offset}}) {
      const auto number = read_number(channel, name);
      if (!number) return refused(number.error().text);
      if (*number) *value = **number;
    }
    channels_.push_back(made);
  }
  return {};
}

Expected<void> IioSession::set_up() {
  const auto rate = set_rate(device_, channels_.front().channel, spec_.rate_hz);
  if (!rate) return refused(rate.error().text);
  rate_hz_ = *rate;
  if (!spec_.trigger.empty()) {
    const iio_device* trigger = iio_context_find_device(context_.get(), spec_.trigger.c_str());
    if (trigger == nullptr || !iio_device_is_trigger(trigger)) return refused("no trigger '" + spec_.trigger + "'");
    if (const int code = iio_device_set_trigger(device_, trigger); code < 0)
      return refused("does not take trigger '" + spec_.trigger + "': " + iio_error(code));
  }
  if (const int code = iio_device_set_kernel_buffers_count(device_, spec_.kernel_buffers); code < 0 && code != -ENOSYS)
    return refused("does not take " + std::to_string(spec_.kernel_buffers) + " kernel_buffers: " + iio_error(code));
  return {};
}

Expected<void> IioSession::start() {
  const PipeGuard guard;
  errno = 0;
  buffer_.reset(iio_device_create_buffer(device_, spec_.buffer, false));
  if (!buffer_) return refused("does not begin to capture: " + iio_error(errno));
  return {};
}

Expected<std::size_t> IioSession::refill() {
  const PipeGuard guard;
  const double begun_s = monotonic_s();
  const ssize_t bytes = iio_buffer_refill(buffer_.get());
  // The network back end of 0.24 tells its timeout as a broken pipe.
  const bool waited = monotonic_s() - begun_s > kOfTimeout * spec_.timeout_s;
  if (bytes == -ETIMEDOUT || (bytes == -EPIPE && waited))
    return refused("gave nothing for " + short_text(spec_.timeout_s) + " s");
  if (bytes == -EPIPE || bytes == -ECONNRESET) return refused("the connection is gone");
  if (bytes < 0) return refused("failed: " + iio_error(static_cast<int>(bytes)));
  const auto step = iio_buffer_step(buffer_.get());
  if (bytes == 0 || step <= 0) return refused("gave no samples");
  return static_cast<std::size_t>(bytes / step);
}

std::int64_t IioSession::raw(const iio_channel* channel, std::size_t sample) const {
  const auto* first = static_cast<const std::uint8_t*>(iio_buffer_first(buffer_.get(), channel));
  const std::uint8_t* at = first + static_cast<std::ptrdiff_t>(sample) * iio_buffer_step(buffer_.get());
  const iio_data_format* format = iio_channel_get_data_format(channel);
  std::uint64_t word = 0;  // libiio gives the host's byte order, shifted and with its sign in the sample's own width
  iio_channel_convert(channel, &word, at);
  const unsigned above = 64 - format->length;
  return format->is_signed ? static_cast<std::int64_t>(word << above) >> above : static_cast<std::int64_t>(word);
}

void IioSession::read(std::size_t channel, std::size_t first, std::span<double> values) const {
  const Channel& c = channels_[channel];
  for (std::size_t n = 0; n < values.size(); ++n)
    values[n] = (static_cast<double>(raw(c.channel, first + n)) + c.offset) * c.scale;
}

std::int64_t IioSession::timestamp(std::size_t sample) const { return raw(timestamp_, sample); }

void IioSession::stop() { buffer_.reset(); }

}  // namespace bodeflow::acquisition
