#include "console/trace_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "console/columns.hpp"
#include "console/console.hpp"
#include "console/record_values.hpp"

namespace bodeflow::tools {
namespace {

constexpr std::size_t kScreen = 110;  ///< characters of a line
constexpr int kName = 28;
constexpr std::size_t kCandidates = 6;       ///< shown of the first step
constexpr std::size_t kLaterCandidates = 3;  ///< of each further one

/// Prints words up to the end of the screen, further lines indented alike.
void print_wrapped(const std::string& text, std::size_t indent) {
  std::string line(indent, ' ');
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find(' ', from), text.size());
    if (line.size() > indent && line.size() + 1 + end - from > kScreen) {
      fmt::print("{}\n", line);
      line.assign(indent, ' ');
    }
    if (line.size() > indent) line += ' ';
    line += text.substr(from, end - from);
    from = end + 1;
  }
  fmt::print("{}\n", line);
}

void print_records(const Json& record) {
  const Values levels = values(record, "record_levels");
  if (levels.data.empty()) return;
  std::string list;
  for (std::size_t i = 0; i < levels.data.size(); ++i)
    if (levels.at(i) > 0.0)  // responses have none
      list += fmt::format("{}{} {:.3g} {}", list.empty() ? "; input rms: " : ", ", text_at(attribute(record, "records"), i),
                          levels.at(i), levels.unit);
  const std::int64_t periods =
      attribute(record, "periods").is_number_integer() ? attribute(record, "periods").get<std::int64_t>() : 0;
  print_wrapped(
      fmt::format("measured: {} from {}{}{}", text(attribute(record, "output_name")), text(attribute(record, "input_name")),
                  periods > 0 ? fmt::format(", {} periods each", periods) : "", list),
      2);
  const Json& notes = attribute(record, "record_notes");
  if (notes.is_array())
    for (std::size_t i = 0; i < notes.size(); ++i) print_wrapped(text_at(notes, i), 2);
}

/// "dead_time and offset": what was added to the model.
std::string added(const Json& record) {
  const Json& effects = attribute(record, "effects");
  std::string all;
  if (effects.is_array())
    for (std::size_t i = 0; i < effects.size(); ++i) all += (i == 0 ? "" : " and ") + text_at(effects, i);
  return all;
}

/// One row a model: its error on a record that was not fitted, what noise alone leaves there, and what is not noise.
void print_errors(const Json& record) {
  fmt::print("  {}\n", dim(fmt::format("{:<{}} {:>12} {:>12} {:>12}", named("error", text(attribute(record, "unit"))), kName,
                                       "all of it", "noise alone", "not noise")));
  const auto row = [&](const std::string& name, const char* error, const char* floor, const char* excess) {
    const double value = number(attribute(record, error));
    if (std::isnan(value)) return;
    fmt::print("  {:<{}} {} {} {}\n", name, kName, cell(value), cell(number(attribute(record, floor))),
               cell(number(attribute(record, excess)), 12, 3));
  };
  const std::string effects = added(record);
  row("the model as declared", "error_before", "noise_floor", "excess_before");
  if (!effects.empty()) row("with " + effects, "error_after", "noise_floor", "excess_after");
  row("measured with the remedy", "error_remedied", "noise_floor_remedied", "excess_remedied");
}

void print_parameters(const Json& record) {
  const Values before = values(record, "parameters_before"), after = values(record, "parameters_after"),
               std = values(record, "parameters_after_std"), own = values(record, "effect_parameters"),
               own_std = values(record, "effect_parameter_std");
  if (before.empty()) return;
  const bool some = !added(record).empty();
  fmt::print("  {}\n", dim(some ? fmt::format("{:<{}} {:>12} {:>12} {:>12}", "parameter", kName, "before", "after", "std")
                                : fmt::format("{:<{}} {:>12} {:>12}", "parameter", kName, "value", "std")));
  for (std::size_t i = 0; i < before.data.size(); ++i) {
    fmt::print("  {:<{}} {}{} {}\n",
               named(text_at(attribute(record, "parameter_names"), i), text_at(attribute(record, "parameter_units"), i)), kName,
               cell(before.at(i)), some ? " " + cell(after.at(i)) : "", cell(std.at(i), 12, 2));
  }
  for (std::size_t i = 0; i < own.data.size(); ++i) {
    fmt::print(
        "  {:<{}} {} {} {}\n",
        named(text_at(attribute(record, "effect_parameter_names"), i), text_at(attribute(record, "effect_parameter_units"), i)),
        kName, cell(std::nan("")), cell(own.at(i)), cell(own_std.at(i), 12, 2));
  }
}

/// What is left of each class on the record that was not fitted, in multiples of the noise.
void print_classes(const Json& record) {
  const Json &names = attribute(record, "class_names"), &records = attribute(record, "class_records");
  const Values before = values(record, "class_before"), after = values(record, "class_after");
  if (!names.is_array() || !records.is_array() || records.empty() || before.shape != std::vector{records.size(), names.size()} ||
      after.shape != before.shape)
    return;
  std::string head = fmt::format("{:<{}}", "left, times the noise", kName), first, second;
  const std::size_t row = records.size() - 1;
  for (std::size_t c = 0; c < names.size(); ++c) {
    head += fmt::format(" {:>9}", text_at(names, c));
    first += " " + cell(before.at(row, c), 9, 3);
    second += " " + cell(after.at(row, c), 9, 3);
  }
  const std::string name = text_at(records, row);
  if (added(record).empty()) {
    fmt::print("  {}\n  {:<{}}{}\n", dim(head), name, kName, first);
    return;
  }
  fmt::print("  {}\n  {:<{}}{}\n  {:<{}}{}\n", dim(head), name + ", before", kName, first, name + ", after", kName, second);
}

/// The best candidates of each step; of the others how many there are.
void print_candidates(const Json& record) {
  const Json &names = attribute(record, "candidate_names"), &reasons = attribute(record, "candidate_reasons"),
             &steps = attribute(record, "candidate_steps");
  const Values share = values(record, "candidate_share");
  if (!names.is_array()) return;
  std::size_t width = kName;
  for (std::size_t i = 0; i < names.size(); ++i) width = std::max(width, text_at(names, i).size());
  fmt::print("  {}\n", dim(fmt::format("{:<{}} {}", "candidate", width, "explains")));
  std::size_t of_step = 0, left_out = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto step = [&](std::size_t n) { return steps.is_array() && n < steps.size() ? number(steps[n]) : 1.0; };
    if (i > 0 && step(i) != step(i - 1)) {
      of_step = 0;
      fmt::print("  {}\n", dim("beside what was found before"));
    }
    if (of_step++ >= (step(i) > 1.0 ? kLaterCandidates : kCandidates)) {
      ++left_out;
      continue;
    }
    fmt::print("  {:<{}} {:>5.1f} %  {}\n", text_at(names, i), width, 100.0 * share.at(i), text_at(reasons, i));
  }
  if (left_out > 0) fmt::print("  {}\n", dim(fmt::format("and {} more, with their reasons, in the report", left_out)));
}

}  // namespace

bool print_trace(const Json& record) {
  const std::string finding = text(attribute(record, "finding"));
  if (finding.empty()) return false;
  if (const std::string remedy = text(attribute(record, "remedy")); !remedy.empty()) {
    print_wrapped(remedy + " " + text(attribute(record, "sentence_remedied")), 2);
    print_errors(record);
    return true;
  }
  print_records(record);
  fmt::print("\n");
  print_wrapped(finding, 2);
  fmt::print("\n");
  print_errors(record);
  print_parameters(record);
  print_classes(record);
  print_candidates(record);
  return true;
}

bool print_reveal(const Json& record) {
  const std::string sentence = text(attribute(record, "sentence"));
  if (sentence.empty()) return false;
  print_wrapped(sentence, 2);
  const Values before = values(record, "parameters_before"), after = values(record, "parameters_after"),
               truth = values(record, "parameters_true");
  if (truth.empty()) return true;
  fmt::print("  {}\n", dim(fmt::format("{:<{}} {:>12} {:>12} {:>12}", "parameter", kName, "before", "after", "truth")));
  for (std::size_t i = 0; i < truth.data.size(); ++i) {
    fmt::print("  {:<{}} {} {} {}\n",
               named(text_at(attribute(record, "parameter_names"), i), text_at(attribute(record, "parameter_units"), i)), kName,
               cell(before.at(i)), cell(after.at(i)), cell(truth.at(i)));
  }
  return true;
}

bool print_amplitude(const Json& record) {
  const std::string limit = text(attribute(record, "limited_by"));
  if (limit.empty()) return false;
  const double signal = number(attribute(record, "signal_to_noise_db"));
  print_wrapped(
      fmt::format("{} = {:.4g}, {:.3g} times the pilot's, set by {}; in the pilot the output was {:.1f} dB above the noise of "
                  "{:.3g}, its peak {:.3g}",
                  text(attribute(record, "parameter")), number(attribute(record, "value")), number(attribute(record, "factor")),
                  limit, signal, number(attribute(record, "noise_std")), number(attribute(record, "output_peak"))),
      2);
  return true;
}

}  // namespace bodeflow::tools
