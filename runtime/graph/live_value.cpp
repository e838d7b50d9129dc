#include "graph/live_value.hpp"

#include <bodeflow/utf8.hpp>
#include <filesystem>

#include "graph/parse.hpp"
#include "graph/value.hpp"

namespace bodeflow::graph {

tl::expected<ParameterValue, std::string> read_live_value(const ParameterDescription& description, const std::string& where,
                                                          const std::string& text, const std::string& own_unit) {
  std::error_code error;
  const Source source{"", std::filesystem::current_path(error).string(), true};
  Report report;
  Node node;
  node.spot = {&source, 0, 0};
  node.origin = &source;
  const std::string_view content = trimmed(text);
  const bool is_word = description.type == BF_STRING || description.type == BF_CHOICE || description.type == BF_FILE;
  if (!is_text(text)) return tl::unexpected(where + ": not UTF-8");
  if (!is_word && !content.empty() && (content.front() == '[' || content.front() == '{')) {
    auto parsed = parse(std::string(content), source, report);
    if (!parsed || !report.empty()) return tl::unexpected(where + ": " + report.problems().front().text);
    node = std::move(*parsed);
  } else if (is_word || !content.empty()) {
    node.kind = Node::Kind::scalar;
    node.text = std::string(content);
  }
  auto value = read_parameter(node, description, where, report, own_unit);
  if (!value) return tl::unexpected(report.empty() ? where + ": can't be read" : report.problems().front().text);
  return std::move(*value);
}

}  // namespace bodeflow::graph
