#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "attributes.hpp"

struct iio_buffer;
struct iio_context;

namespace bodeflow::acquisition {

/// What is asked of a device of Linux IIO.
struct IioSpec {
  std::string uri = "local:";
  std::string device;                 ///< by name, label or id
  std::vector<std::string> channels;  ///< by id
  std::string trigger;                ///< by name or id; "": as it is
  std::vector<IioAttribute> attributes;
  double rate_hz = 1000.0;
  std::size_t buffer = 4096;    ///< samples handed over at once
  unsigned kernel_buffers = 8;  ///< of these
  double timeout_s = 2.0;       ///< a device that gives nothing for so long has failed
  bool timestamps = false;      ///< its channel `timestamp` is read, too
};

/// A device of Linux IIO that captures, through libiio: on this machine, or over a network.
class IioSession {
 public:
  /// Opens the device, sets rate and attributes; it captures from the first `refill` on. Errors: what was found, what there is.
  static Expected<IioSession> open(const IioSpec& spec);

  /// Begins to capture. Error: the device's refusal.
  Expected<void> start();
  /// Waits for the next samples; how many. Errors: none for the timeout, a connection that is gone, the device's error.
  Expected<std::size_t> refill();
  /// Of the samples last given, those from `first` on, in the unit in which the kernel scales: (raw + offset) * scale.
  void read(std::size_t channel, std::size_t first, std::span<double> values) const;
  /// Time stamp of a sample, in nanoseconds of the device's clock. Precondition: spec.timestamps.
  std::int64_t timestamp(std::size_t sample) const;
  /// Ends the capture.
  void stop();

  /// None where the device does not tell.
  std::optional<double> rate_hz() const { return rate_hz_; }
  const IioSpec& spec() const { return spec_; }

 private:
  struct Channel {
    iio_channel* channel = nullptr;
    double scale = 1.0, offset = 0.0;
  };
  struct CloseContext {
    void operator()(iio_context* context) const;
  };
  struct CloseBuffer {
    void operator()(iio_buffer* buffer) const;
  };

  Expected<void> find_device();
  Expected<void> write_attributes();
  Expected<void> find_channels();
  Expected<void> set_up();
  std::int64_t raw(const iio_channel* channel, std::size_t sample) const;
  Unexpected<Error> refused(const std::string& what) const;

  IioSpec spec_;
  std::unique_ptr<iio_context, CloseContext> context_;
  iio_device* device_ = nullptr;
  std::vector<Channel> channels_;
  iio_channel* timestamp_ = nullptr;
  std::unique_ptr<iio_buffer, CloseBuffer> buffer_;
  std::optional<double> rate_hz_;
};

}  // namespace bodeflow::acquisition
