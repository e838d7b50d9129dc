#include "plugins/stream_facts.hpp"

#include <fmt/format.h>

namespace bodeflow {
namespace {

constexpr std::uint32_t kMostChannels = 65536;
constexpr std::uint32_t kMostSamples = 1U << 26U;  // of a firing
constexpr std::uint64_t kLongestDelay = std::uint64_t{1} << 40U;
constexpr std::uint64_t kMostNotes = 256, kLongestNote = 1U << 20U;
constexpr std::uint64_t kMostInitial = std::uint64_t{1} << 28U;  // values

std::string text(const char* c) { return c == nullptr ? std::string() : std::string(c); }

std::vector<std::string> texts(const char* const* list, std::uint32_t count) {
  std::vector<std::string> found;
  for (std::uint32_t i = 0; list != nullptr && i < count; ++i) found.push_back(text(list[i]));
  return found;
}

}  // namespace

FactsView::FactsView(const std::vector<StreamFacts>& facts) {
  const auto pointers = [&](const std::vector<std::string>& list) -> const char* const* {
    if (list.empty()) return nullptr;
    std::vector<const char*>& made = names_.emplace_back();
    for (const std::string& name : list) made.push_back(name.c_str());
    return made.data();
  };
  names_.reserve(2 * facts.size());
  notes_.reserve(facts.size());
  for (const StreamFacts& f : facts) {
    bf_stream_facts c{};
    c.struct_size = sizeof c;
    c.known = f.known ? 1 : 0;
    c.element = f.element;
    c.channels = f.channels;
    c.rate = f.rate.c();
    c.length = f.length;
    c.unit = f.unit.c_str();
    c.clock = f.clock.c_str();
    // a list shorter than the channels would be read beyond its end
    c.channel_names = f.channel_names.size() == f.channels ? pointers(f.channel_names) : nullptr;
    c.channel_units = f.channel_units.size() == f.channels ? pointers(f.channel_units) : nullptr;
    std::vector<bf_note>& notes = notes_.emplace_back();
    for (const auto& [name, values] : f.notes) notes.push_back({name.c_str(), values.data(), values.size()});
    c.notes = notes.data();
    c.note_count = notes.size();
    c_.push_back(c);
  }
}

tl::expected<StreamFacts, std::string> owned(const bf_stream_facts& c, const std::string& port) {
  StreamFacts facts;
  if (c.known == 0) return facts;
  const auto bad = [&](const std::string& what) { return tl::unexpected("output '" + port + "': " + what); };
  if (c.element != BF_F64 && c.element != BF_C64) return bad(fmt::format("element type {}; allowed: f64, c64", c.element));
  if (c.channels < 1 || c.channels > kMostChannels)
    return bad(fmt::format("{} channels; allowed: 1 to {}", c.channels, kMostChannels));
  if (c.rate.num < 0 || (c.rate.num > 0 && c.rate.den <= 0))
    return bad(fmt::format("a rate of {}/{} Hz", c.rate.num, c.rate.den));
  if (c.length < -1) return bad(fmt::format("a length of {} samples", c.length));
  facts.known = true;
  facts.element = c.element;
  facts.channels = c.channels;
  facts.rate = c.rate.num == 0 ? Rate{} : Rate(c.rate);
  facts.length = c.length;
  facts.unit = text(c.unit);
  facts.clock = text(c.clock);
  facts.channel_names = texts(c.channel_names, c.channels);
  facts.channel_units = texts(c.channel_units, c.channels);
  if (c.note_count > kMostNotes) return bad(fmt::format("{} notes; allowed: up to {}", c.note_count, kMostNotes));
  for (std::uint64_t i = 0; c.notes != nullptr && i < c.note_count; ++i) {
    const bf_note& note = c.notes[i];
    if (note.count > kLongestNote)
      return bad(fmt::format("note '{}' with {} values; allowed: up to {}", text(note.name), note.count, kLongestNote));
    facts.notes[text(note.name)].assign(note.values, note.values + note.count);
  }
  return facts;
}

tl::expected<Flow, std::string> owned(const bf_flow& c, const StreamFacts* facts, const std::string& port) {
  const auto bad = [&](const std::string& what) {
    return tl::unexpected(std::string(facts == nullptr ? "output" : "input") + " '" + port + "': " + what);
  };
  if (c.samples < 1 || c.samples > kMostSamples)
    return bad(fmt::format("{} samples a firing; allowed: 1 to {}", c.samples, kMostSamples));
  Flow flow;
  flow.samples = c.samples;
  if (facts == nullptr) return flow;
  if (c.delay > kLongestDelay) return bad(fmt::format("a delay of {} samples; allowed: up to {}", c.delay, kLongestDelay));
  flow.delay = c.delay;
  if (c.initial == nullptr || !facts->known) return flow;
  const std::uint64_t width = std::uint64_t{facts->channels} * (facts->element == BF_C64 ? 2 : 1);
  if (width > 0 && c.delay > kMostInitial / width)
    return bad(fmt::format("initial values for a delay of {} samples are too many", c.delay));
  flow.initial.assign(c.initial, c.initial + c.delay * width);
  return flow;
}

}  // namespace bodeflow
