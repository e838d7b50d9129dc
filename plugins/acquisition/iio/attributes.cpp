#include "attributes.hpp"

#include <iio.h>

#include <array>

#include "acquisition/sampling.hpp"

namespace bodeflow::acquisition {
namespace {

constexpr const char* kRate = "sampling_frequency";

template <class Name>
std::string list(unsigned count, Name&& name) {
  std::string text;
  for (unsigned i = 0; i < count; ++i) text += (i == 0 ? "" : ", ") + std::string(name(i));
  return text.empty() ? "none" : text;
}

}  // namespace

std::string iio_error(int code) {
  std::array<char, 256> text{};
  iio_strerror(code < 0 ? -code : code, text.data(), text.size());
  return text.data();
}

Expected<IioAttribute> iio_attribute(const std::string& text) {
  const auto equal = text.find('=');
  if (equal == std::string::npos || equal == 0)
    return unexpected("attribute '" + text + "'; allowed: name=value of the device, or channel/name=value");
  IioAttribute attribute;
  attribute.name = text.substr(0, equal);
  attribute.value = text.substr(equal + 1);
  if (const auto slash = attribute.name.find('/'); slash != std::string::npos) {
    attribute.channel = attribute.name.substr(0, slash);
    attribute.name = attribute.name.substr(slash + 1);
  }
  return attribute;
}

Expected<void> write_attribute(const iio_device* device, const IioAttribute& attribute) {
  ssize_t done = 0;
  if (attribute.channel.empty()) {
    if (iio_device_find_attr(device, attribute.name.c_str()) == nullptr)
      return unexpected("the device has no attribute '" + attribute.name + "'; it has " +
                        list(iio_device_get_attrs_count(device), [&](unsigned i) { return iio_device_get_attr(device, i); }));
    done = iio_device_attr_write(device, attribute.name.c_str(), attribute.value.c_str());
  } else {
    const iio_channel* channel = iio_device_find_channel(device, attribute.channel.c_str(), false);
    if (channel == nullptr) return unexpected("the device has no input channel '" + attribute.channel + "'");
    if (iio_channel_find_attr(channel, attribute.name.c_str()) == nullptr)
      return unexpected("channel '" + attribute.channel + "' has no attribute '" + attribute.name + "'; it has " +
                        list(iio_channel_get_attrs_count(channel), [&](unsigned i) { return iio_channel_get_attr(channel, i); }));
    done = iio_channel_attr_write(channel, attribute.name.c_str(), attribute.value.c_str());
  }
  if (done < 0)
    return unexpected("attribute '" + attribute.name + "' does not take '" + attribute.value +
                      "': " + iio_error(static_cast<int>(done)));
  return {};
}

Expected<std::optional<double>> read_number(const iio_channel* channel, const char* name) {
  if (iio_channel_find_attr(channel, name) == nullptr) return std::optional<double>();
  double value = 0.0;
  if (const int code = iio_channel_attr_read_double(channel, name, &value); code < 0)
    return unexpected("attribute '" + std::string(name) + "' of channel '" + iio_channel_get_id(channel) +
                      "' can't be read: " + iio_error(code));
  return std::optional<double>(value);
}

Expected<std::optional<double>> set_rate(const iio_device* device, const iio_channel* channel, double rate_hz) {
  const bool of_device = iio_device_find_attr(device, kRate) != nullptr;
  if (!of_device && iio_channel_find_attr(channel, kRate) == nullptr) return std::optional<double>();
  const std::string text = number_text(rate_hz);
  const auto written =
      of_device ? iio_device_attr_write(device, kRate, text.c_str()) : iio_channel_attr_write(channel, kRate, text.c_str());
  if (written < 0)
    return unexpected("the device does not take a sampling_frequency of " + text +
                      " Hz: " + iio_error(static_cast<int>(written)));
  double rate = 0.0;
  const int code =
      of_device ? iio_device_attr_read_double(device, kRate, &rate) : iio_channel_attr_read_double(channel, kRate, &rate);
  if (code < 0) return unexpected("sampling_frequency can't be read back: " + iio_error(code));
  return std::optional<double>(rate);
}

}  // namespace bodeflow::acquisition
