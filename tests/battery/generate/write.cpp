#include "generate/write.hpp"

#include <charconv>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace battery {
namespace {

/// 9 digits, always 15 characters: +1.23456789e-03.
void add_fixed(std::string& text, double value) {
  char number[32];
  std::snprintf(number, sizeof number, "%+.8e", value);
  text += number;
}

std::string shortest(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return std::string(text, end.ptr);
}

template <class T, class Text>
std::string list(const std::vector<T>& values, Text text) {
  std::string all = "[";
  for (std::size_t n = 0; n < values.size(); ++n) all += (n ? ", " : "") + text(values[n]);
  return all + "]";
}

std::string quoted(const std::string& text) { return '"' + text + '"'; }

}  // namespace

std::string csv_text(const Case& c, const CaseRecord& r) {
  std::string text = "u [" + c.input_unit + "],y [" + c.output_unit + "]\n";
  text.reserve(text.size() + r.input.size() * 32);
  for (std::size_t n = 0; n < r.input.size(); ++n) {
    add_fixed(text, r.input[n]);
    text += ',';
    add_fixed(text, r.output[n]);
    text += '\n';
  }
  return text;
}

std::string case_json(const std::string& number, const Case& c) {
  const Drive& d = c.records.front().drive;
  std::string text =
      "{\"case\": " + quoted(number) + ", \"plant\": " + quoted(c.plant) + ",\n \"rate_hz\": " + shortest(1.0 / c.sample_time);
  text += ", \"period\": " + std::to_string(d.period) + ", \"periods\": " + std::to_string(kPeriods) + ", \"skip\": 1";
  text += ",\n \"units\": {\"u\": " + quoted(c.input_unit) + ", \"y\": " + quoted(c.output_unit) + "}";
  text += ",\n \"lines\": " + list(d.lines, [](int line) { return std::to_string(line); }) + ",\n \"levels\": {";
  for (std::size_t n = 0; n < c.records.size(); ++n) {
    text += (n ? ", " : "") + quoted(c.records[n].name) + ": " + shortest(c.records[n].drive.level);
  }
  return text + "}}\n";
}

std::string truth_json(const std::string& number, const Case& c) {
  std::string text = "{\"case\": " + quoted(number) + ", \"plant\": " + quoted(c.plant) + ", \"class\": " + quoted(word(c.kind));
  text += ", \"effect\": " + quoted(c.effect) + ", \"size\": " + shortest(c.size) + ", \"strength\": " + shortest(c.strength);
  text += ", \"noise\": " + shortest(c.noise) + ", \"snr_db\": " + shortest(c.signal_to_noise);
  text += std::string(", \"coloured\": ") + (c.coloured ? "true" : "false");
  text += ", \"plant_parameters\": " + list(c.parameters, shortest) + ", \"values\": ";
  return text +
         list(c.values,
              [](const Value& v) {
                return "{\"name\": " + quoted(v.name) + ", \"unit\": " + quoted(v.unit) + ", \"value\": " + shortest(v.value) +
                       "}";
              }) +
         "}";
}

void write_file(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw std::runtime_error("can't write " + file.string());
  const std::chrono::sys_seconds epoch{};
  std::filesystem::last_write_time(file, std::chrono::file_clock::from_sys(epoch));
}

}  // namespace battery
