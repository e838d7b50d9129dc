#include "channels.hpp"

#include <algorithm>
#include <bodeflow/units.hpp>

#include "acquisition/number_line.hpp"

namespace bodeflow::acquisition {

std::string Channels::unit() const {
  const auto same = [&](const ChannelScale& s) { return s.unit == scales.front().unit; };
  return !scales.empty() && std::all_of(scales.begin(), scales.end(), same) ? scales.front().unit : "";
}

void Channels::state(StreamFacts& facts) const {
  facts.channels = static_cast<int>(names.size());
  facts.channel_names = names;
  facts.channel_units.clear();
  for (const ChannelScale& s : scales) facts.channel_units.push_back(s.unit);
  facts.unit = unit();
}

void describe_scale(Describe& d, const std::string& prefix, const std::string& reading) {
  d.parameter(prefix + "scale", std::vector<double>{1.0})
      .unit("")
      .doc("physical value of " + reading + ": one number, or one for each channel");
  d.parameter(prefix + "unit", "").doc("unit of the values that `scale` gives, such as V");
  d.optional<File>(prefix + "calibration")
      .doc(
          "CSV with a row for each channel and the columns channel, gain, offset, unit: value = gain * reading + offset, the "
          "reading being in units of " +
          reading + "; takes the place of scale and unit");
}

ScaleSettings read_scale(const Parameters& p, const std::string& prefix) {
  ScaleSettings settings;
  settings.scale = p.numbers(prefix + "scale");
  settings.unit = p.text(prefix + "unit");
  if (!is_known_unit(settings.unit)) fail(prefix + "unit: '" + settings.unit + "' is not a unit");
  if (!p.has(prefix + "calibration")) return settings;
  if (p.given(prefix + "scale") || p.given(prefix + "unit"))
    fail(prefix + "calibration gives the scales and units: leave out " + prefix + "scale and " + prefix + "unit");
  settings.calibration = p.text(prefix + "calibration");
  return settings;
}

Channels make_channels(const ScaleSettings& settings, std::vector<std::string> names) {
  Channels channels;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (std::find(names.begin() + static_cast<std::ptrdiff_t>(i) + 1, names.end(), names[i]) != names.end())
      fail("channel '" + names[i] + "' stands twice");
  channels.names = std::move(names);
  channels.calibration = settings.calibration;
  if (settings.calibration.empty()) {
    if (settings.scale.size() != 1 && settings.scale.size() != channels.names.size())
      fail("scale has " + std::to_string(settings.scale.size()) + " values; allowed: one, or one for each of the " +
           counted(channels.names.size(), "channel"));
    for (std::size_t c = 0; c < channels.names.size(); ++c) {
      const double gain = settings.scale[settings.scale.size() == 1 ? 0 : c];
      if (gain == 0.0) fail("scale has a 0; allowed: any other number");
      channels.scales.push_back({gain, 0.0, settings.unit});
    }
    return channels;
  }
  auto source = open_file(settings.calibration);
  if (!source) fail(settings.calibration + ": " + source.error().text);
  const auto rows = read_calibration(**source);
  if (!rows) fail(text_at(settings.calibration, rows.error()));
  auto scales = scales_of(*rows, channels.names);
  if (!scales) fail(settings.calibration + ": " + scales.error().text);
  channels.scales = std::move(*scales);
  return channels;
}

std::vector<std::string> numbered_channels(int count) {
  std::vector<std::string> names;
  for (int c = 1; c <= count; ++c) names.push_back("ch" + std::to_string(c));
  return names;
}

}  // namespace bodeflow::acquisition
