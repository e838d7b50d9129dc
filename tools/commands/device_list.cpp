#include "commands/device_list.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "console/console.hpp"
#include "plan/names.hpp"
#include "record/recorder.hpp"

namespace bodeflow::tools {
namespace {

using Json = nlohmann::ordered_json;

/// Channels that are told one by one; of more, what holds for all.
constexpr std::size_t kMostChannels = 4;

std::string unit_of(const StreamFacts& stream, std::size_t channel) {
  return channel < stream.channel_units.size() ? stream.channel_units[channel] : stream.unit;
}

std::string name_of(const StreamFacts& stream, std::size_t channel) {
  return channel < stream.channel_names.size() ? stream.channel_names[channel] : fmt::format("channel {}", channel);
}

std::string bracketed(const std::string& unit) { return unit.empty() || unit == "1" ? "" : " [" + unit + "]"; }

std::string parameters_text(const graph::Block& block) {
  std::string text;
  for (std::size_t i = 0; i < block.parameters.size(); ++i) {
    const ParameterValue& value = block.parameters[i];
    if (!value.given) continue;
    const ParameterDescription& described = block.type->parameters[i];
    text += (text.empty() ? "" : ", ") + described.name + " ";
    if (described.type == BF_NUMBER)
      text += plan::value_text(value.numbers.at(0), described.unit);
    else if (!value.strings.empty())
      text += fmt::format("{}", fmt::join(value.strings, ", "));
    else
      text += record::to_json(value).dump();
  }
  return text;
}

}  // namespace

const StreamFacts& DeviceList::stream(const graph::End& end, bool input) const {
  const plan::Facts::Block& block = prepared_.facts.blocks[static_cast<std::size_t>(end.block)];
  return (input ? block.inputs : block.outputs)[static_cast<std::size_t>(end.port)];
}

/// "set_points: target_speed [rpm], 50 Hz".
std::string DeviceList::signal_text(const graph::End& end, bool input) const {
  const StreamFacts& facts = stream(end, input);
  const auto& port =
      phase_.blocks[static_cast<std::size_t>(end.block)].type->port_at(BF_STREAM, input ? BF_IN : BF_OUT, end.port);
  if (!facts.known) return port.name + ": not connected";
  std::string channels;
  if (facts.channel_names.empty() || facts.channels > 2 * kMostChannels) {
    channels = plan::count_text(facts.channels, "channel") + bracketed(facts.unit);
  } else {
    for (std::size_t c = 0; c < facts.channels; ++c)
      channels += (c > 0 ? ", " : "") + name_of(facts, c) + bracketed(unit_of(facts, c));
  }
  return fmt::format("{}: {}, {}", port.name, channels, plan::rate_text(facts.rate));
}

std::string DeviceList::limits_text(const graph::End& end, bool input) const {
  std::string text;
  for (std::size_t i = 0; i < phase_.limits.size(); ++i)
    if (phase_.limits[i].port == end && phase_.limits[i].input == input)
      text += "    limit: " + plan::to_text(prepared_.plan.limits[i]).substr(prepared_.plan.limits[i].signal.size() + 2) + "\n";
  return text.empty() ? "    no limit\n" : text;
}

/// "-13.2 to 635 rpm, largest at 4.36 s, changes of up to 820 rpm/s", of each channel.
std::string DeviceList::extremes_text(const phases::Excitation& excitation) const {
  const StreamFacts& facts = stream(excitation.from, false);
  if (excitation.channels.empty()) return "no samples";
  const auto one = [&](const phases::Extremes& e, const std::string& unit) {
    const std::string none =
        e.not_finite == 0 ? "" : plan::count_text(static_cast<std::int64_t>(e.not_finite), "sample") + " of it no finite number";
    if (e.finite == 0) return none;
    return fmt::format("{:.6g} to {}, largest at {}, changes of up to {}{}{}", e.lowest, plan::value_text(e.highest, unit),
                       plan::seconds_text(e.largest_at_s), plan::value_text(e.steepest, (unit.empty() ? "1" : unit) + "/s"),
                       none.empty() ? "" : "; ", none);
  };
  std::string text;
  for (std::size_t c = 0; c < std::min(excitation.channels.size(), kMostChannels); ++c)
    text += (c > 0 ? "; " : "") + (excitation.channels.size() > 1 ? name_of(facts, c) + " " : "") +
            one(excitation.channels[c], unit_of(facts, c));
  if (excitation.channels.size() > kMostChannels)
    text += fmt::format("; {} more channels", excitation.channels.size() - kMostChannels);
  if (const auto lines = facts.notes.find("excitation.frequencies"); lines != facts.notes.end() && !lines->second.empty()) {
    const auto [low, high] = std::minmax_element(lines->second.begin(), lines->second.end());
    text +=
        fmt::format("; excited at {} from {} to {}", plan::count_text(static_cast<std::int64_t>(lines->second.size()), "line"),
                    plan::value_text(*low, ""), plan::value_text(*high, "Hz"));
  }
  if (!excitations_.whole) text += "; in the first " + plan::seconds_text(excitations_.time_s) + " of the run";
  return text;
}

/// What limits promise where the excitation is not known.
std::string DeviceList::bounded_text(const graph::End& end) const {
  std::string text;
  for (std::size_t i = 0; i < phase_.limits.size(); ++i) {
    const plan::Limit& limit = prepared_.plan.limits[i];
    if (!(phase_.limits[i].port == end) || !phase_.limits[i].input || limit.on_violation == graph::OnViolation::warn) continue;
    text += fmt::format("{}{}{}", text.empty() ? "" : "; ", limit.all_channels ? "" : limit.names.front() + " ",
                        plan::bounds_text(limit));
  }
  return text.empty() ? "no limit bounds it" : "its limits keep it within " + text;
}

std::string DeviceList::input_text(const phases::DeviceInput& input) const {
  std::string text = "    largest excitation: ";
  if (!excitations_.failure.empty()) return text + "not known before the run: " + excitations_.failure + "\n";
  if (input.depends_on.empty()) return text + extremes_text(excitations_.streams[input.excitations.front()]) + "\n";
  std::string names;
  for (const int block : input.depends_on)
    names += (names.empty() ? "'" : ", '") + phase_.blocks[static_cast<std::size_t>(block)].name + "'";
  text += fmt::format("not known before the run, it depends on {}; {}\n", names, bounded_text(input.to));
  for (const std::size_t known : input.excitations) {
    const phases::Excitation& excitation = excitations_.streams[known];
    text += fmt::format("    in front of it, {}: {}\n", plan::stream_output(phase_, excitation.from), extremes_text(excitation));
  }
  return text;
}

const phases::DeviceInput* DeviceList::input_of(const graph::End& end) const {
  for (const phases::DeviceInput& input : excitations_.inputs)
    if (input.to == end) return &input;
  return nullptr;
}

std::string DeviceList::device_text(std::size_t block) const {
  const graph::Block& device = phase_.blocks[block];
  std::string text =
      fmt::format("{}: {}{}\n", bold(device.name), device.type->id, device.host.empty() ? "" : " on host '" + device.host + "'");
  if (const std::string parameters = parameters_text(device); !parameters.empty()) text += "  " + parameters + "\n";
  const auto& facts = prepared_.facts.blocks[block];
  for (int port = 0; port < static_cast<int>(facts.inputs.size()); ++port) {
    const graph::End end{static_cast<int>(block), port};
    text += "  gets " + signal_text(end, true) + "\n";
    if (!stream(end, true).known) continue;
    text += limits_text(end, true);
    if (const phases::DeviceInput* input = input_of(end)) text += input_text(*input);
  }
  for (int port = 0; port < static_cast<int>(facts.outputs.size()); ++port) {
    const graph::End end{static_cast<int>(block), port};
    text += "  gives " + signal_text(end, false) + "\n" + limits_text(end, false);
  }
  for (const graph::MessageEdge& edge : phase_.messages)
    if (edge.to.block == static_cast<int>(block))
      text += "  gets the records of " + plan::message_output(phase_, edge.from) + "\n";
  return text;
}

bool DeviceList::any() const { return std::any_of(phase_.blocks.begin(), phase_.blocks.end(), phases::is_outside); }

std::string DeviceList::text() const {
  std::string text, others;
  for (std::size_t i = 0; i < phase_.blocks.size(); ++i)
    if (is_outside(i)) text += device_text(i);
  for (std::size_t i = 0; i < phase_.limits.size(); ++i)
    if (!is_outside(static_cast<std::size_t>(phase_.limits[i].port.block)))
      others += "  " + plan::to_text(prepared_.plan.limits[i]) + "\n";
  const std::string phase = phase_.name.empty() ? "" : fmt::format(" of phase '{}'", phase_.name);
  if (!text.empty()) text = fmt::format("\n{}\n{}", bold("Devices and network" + phase), text);
  if (!others.empty()) text += fmt::format("\n{}\n{}", bold((any() ? "Limits of other signals" : "Limits") + phase), others);
  return text;
}

Json DeviceList::signal_json(const graph::End& end, bool input) const {
  const StreamFacts& facts = stream(end, input);
  const auto& port =
      phase_.blocks[static_cast<std::size_t>(end.block)].type->port_at(BF_STREAM, input ? BF_IN : BF_OUT, end.port);
  Json json{{"port", port.name}, {"connected", facts.known}};
  if (!facts.known) return json;
  json["rate_hz"] = facts.rate.hz();
  json["channels"] = Json::array();
  for (std::size_t c = 0; c < facts.channels; ++c)
    json["channels"].push_back({{"name", name_of(facts, c)}, {"unit", unit_of(facts, c)}});
  json["limits"] = Json::array();
  for (std::size_t i = 0; i < phase_.limits.size(); ++i)
    if (phase_.limits[i].port == end && phase_.limits[i].input == input) json["limits"].push_back(i);
  return json;
}

Json DeviceList::input_json(const phases::DeviceInput& input) const {
  Json depends = Json::array(), streams = Json::array();
  for (const int block : input.depends_on) depends.push_back(phase_.blocks[static_cast<std::size_t>(block)].name);
  if (excitations_.failure.empty())
    for (const std::size_t known : input.excitations) {
      const phases::Excitation& excitation = excitations_.streams[known];
      Json channels = Json::array();
      for (const phases::Extremes& e : excitation.channels)
        channels.push_back({{"lowest", e.lowest},
                            {"highest", e.highest},
                            {"largest_at_s", e.largest_at_s},
                            {"steepest_per_s", e.steepest},
                            {"not_finite", e.not_finite}});
      streams.push_back({{"signal", plan::stream_output(phase_, excitation.from)}, {"channels", channels}});
    }
  Json json{{"known", depends.empty() && excitations_.failure.empty()}, {"depends_on", depends}, {"streams", streams}};
  if (!excitations_.failure.empty()) json["reason"] = excitations_.failure;
  if (!excitations_.whole) json["only_first_s"] = excitations_.time_s;
  return json;
}

Json DeviceList::device_json(std::size_t block) const {
  const graph::Block& device = phase_.blocks[block];
  Json parameters = Json::object(), gets = Json::array(), gives = Json::array();
  for (std::size_t i = 0; i < device.parameters.size(); ++i)
    if (device.parameters[i].given) parameters[device.type->parameters[i].name] = record::to_json(device.parameters[i]);
  const auto& facts = prepared_.facts.blocks[block];
  for (int port = 0; port < static_cast<int>(facts.inputs.size()); ++port) {
    gets.push_back(signal_json({static_cast<int>(block), port}, true));
    if (const auto* input = input_of({static_cast<int>(block), port})) gets.back()["excitation"] = input_json(*input);
  }
  for (int port = 0; port < static_cast<int>(facts.outputs.size()); ++port)
    gives.push_back(signal_json({static_cast<int>(block), port}, false));
  return {{"name", device.name}, {"block", device.type->id}, {"host", device.host}, {"parameters", parameters}, {"gets", gets},
          {"gives", gives}};
}

Json DeviceList::json() const {
  Json devices = Json::array(), limits = Json::array();
  for (std::size_t i = 0; i < phase_.blocks.size(); ++i)
    if (is_outside(i)) devices.push_back(device_json(i));
  for (const plan::Limit& limit : prepared_.plan.limits) limits.push_back(Json(plan::to_json(limit)));
  return {{"devices", devices}, {"limits", limits}};
}

}  // namespace bodeflow::tools
