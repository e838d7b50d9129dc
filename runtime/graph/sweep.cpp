#include "graph/sweep.hpp"

#include <fmt/format.h>

#include "graph/ends.hpp"
#include "graph/expand.hpp"
#include "graph/keys.hpp"
#include "graph/run_settings.hpp"
#include "graph/scalar.hpp"
#include "graph/value.hpp"

namespace bodeflow::graph {
namespace {

Node scalar_node(std::string text, const Node& like) {
  Node node;
  node.kind = Node::Kind::scalar;
  node.spot = like.spot;
  node.origin = like.origin;
  node.text = std::move(text);
  return node;
}

/// `1..100`; nothing: not a range, or reported.
std::optional<std::vector<Node>> read_range(const Node& node, const std::string& where, Report& report) {
  const auto dots = node.text.find("..");
  if (dots == std::string::npos) {
    report.add(node.spot, fmt::format("{}: found {}, allowed: a list of values, or a range such as 1..100", where, what(node)));
    return {};
  }
  const auto first = integer_of(std::string_view(node.text).substr(0, dots));
  const auto last = integer_of(std::string_view(node.text).substr(dots + 2));
  if (!first || !last || *last < *first) {
    report.add(node.spot,
               fmt::format("{}: found {}, allowed: a range such as 1..100, the lower number first", where, quote(node.text)));
    return {};
  }
  const auto count = static_cast<std::uint64_t>(*last) - static_cast<std::uint64_t>(*first);
  if (count >= static_cast<std::uint64_t>(kMostSweepValues)) {
    report.add(node.spot, fmt::format("{}: more than {} values", where, kMostSweepValues));
    return {};
  }
  std::vector<Node> values;
  for (std::int64_t v = *first;; ++v) {
    values.push_back(scalar_node(std::to_string(v), node));
    if (v == *last) return values;
  }
}

/// Checks values against what the path names.
class Axis {
 public:
  Axis(const Entry& entry, const Phase& phase, Report& report)
      : path_(entry.key), where_("sweep: " + entry.key), phase_(phase), report_(report) {}

  bool find(const Spot& spot) {
    if (path_ == "seed") return true;
    const auto dot = path_.find('.');
    const std::string first = path_.substr(0, dot), rest = dot == std::string::npos ? "" : path_.substr(dot + 1);
    if (first == "run" && !rest.empty()) return find_setting(rest, spot);
    if (rest.empty()) {
      report_.add(spot, fmt::format("sweep: {} is no path; allowed: seed, block.parameter, run.key", quote(path_)));
      return false;
    }
    const BlockIndex blocks(phase_);
    const int index = blocks.find(first, spot, report_);
    if (index < 0 || blocks.type(index) == nullptr) return false;
    const BlockDescription& type = *blocks.type(index);
    const int parameter = type.parameter(rest);
    if (parameter >= 0) {
      parameter_ = &type.parameters[static_cast<std::size_t>(parameter)];
      return true;
    }
    Names names;
    for (const auto& p : type.parameters) names.push_back(p.name);
    report_.add(spot, fmt::format("sweep: block '{}': unknown parameter {}{}", first, quote(rest), did_you_mean(rest, names)));
    return false;
  }

  /// The value in the words of a --set. Nothing: reported.
  /// A path of a file becomes absolute, in the node as well.
  std::optional<std::string> check(Node& value) {
    if (parameter_ != nullptr) {
      if (!read_parameter(value, *parameter_, where_, report_)) return {};
    } else if (path_ == "seed") {
      if (!read_seed(value, where_, report_)) return {};
    } else if (!check_setting(value)) {
      return {};
    }
    return value.is_scalar() ? value.text : flow_text(value);
  }

 private:
  bool find_setting(const std::string& key, const Spot& spot) {
    for (const auto& known : run_keys())
      if (known == key) return true;
    report_.add(spot, fmt::format("sweep: run: unknown key {}{}", quote(key), did_you_mean(key, run_keys())));
    return false;
  }

  bool check_setting(const Node& value) {
    Node run;
    run.kind = Node::Kind::map;
    run.entries.push_back({path_.substr(4), value.spot, value});
    RunSettings unused;
    const std::size_t before = report_.size();
    read_run(run, unused, report_);
    return report_.size() == before;
  }

  const std::string& path_;
  std::string where_;
  const Phase& phase_;
  Report& report_;
  const ParameterDescription* parameter_ = nullptr;
};

}  // namespace

void read_sweep(Node& node, Phase& phase, Report& report) {
  if (node.is_none() || !require_map(node, "sweep", "a map such as {seed: 1..100}", report)) return;
  std::size_t runs = 1;
  for (auto& e : node.entries) {
    Axis axis(e, phase, report);
    const std::string where = "sweep: " + e.key;
    if (!axis.find(e.spot) || e.value.broken) continue;
    std::optional<std::vector<Node>> values;
    if (e.value.is_list()) values = e.value.items;
    if (!e.value.is_list()) values = read_range(e.value, where, report);
    if (!values) continue;
    if (values->empty()) report.add(e.value.spot, fmt::format("{}: an empty list, allowed: at least one value", where));
    SweepAxis made{e.key, {}, e.spot.place()};
    for (auto& value : *values)
      if (auto text = axis.check(value)) made.values.push_back(std::move(*text));
    if (e.value.is_list()) e.value.items = *values;
    runs *= std::max<std::size_t>(1, made.values.size());
    if (runs > static_cast<std::size_t>(kMostSweepValues)) {
      report.add(e.spot, fmt::format("sweep: more than {} runs", kMostSweepValues));
      return;
    }
    phase.sweep.push_back(std::move(made));
  }
}

}  // namespace bodeflow::graph
