#include "graph/parse.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <sstream>
#include <unordered_map>

#include "graph/guard.hpp"

namespace bodeflow::graph {
namespace {

/// Ends the parsing; the problem is in the report.
struct Stop {};

/// yaml-cpp counts lines and columns from zero, columns in bytes; we from one, in characters.
class Lines {
 public:
  Lines(std::string_view text, const Source& source) : text_(text), source_(source) {
    starts_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') starts_.push_back(i + 1);
  }

  std::size_t offset(const YAML::Mark& mark) const {
    if (mark.is_null() || mark.line < 0 || mark.column < 0) return text_.size();
    const auto line = static_cast<std::size_t>(mark.line);
    if (line >= starts_.size()) return text_.size();
    return std::min(text_.size(), starts_[line] + static_cast<std::size_t>(mark.column));
  }

  Spot spot(const YAML::Mark& mark) const {
    if (mark.is_null() || mark.line < 0 || static_cast<std::size_t>(mark.line) >= starts_.size()) return {&source_, 0, 0};
    const std::size_t start = starts_[static_cast<std::size_t>(mark.line)];
    const std::size_t end = std::max(start, offset(mark));
    return {&source_, mark.line + 1, static_cast<int>(characters(text_.substr(start, end - start))) + 1};
  }

  std::string_view line_of(const YAML::Mark& mark) const {
    if (mark.is_null() || mark.line < 0 || static_cast<std::size_t>(mark.line) >= starts_.size()) return {};
    const std::string_view rest = text_.substr(starts_[static_cast<std::size_t>(mark.line)]);
    return rest.substr(0, rest.find('\n'));
  }

  /// True for a text in quotes that end before the file does. yaml-cpp takes the end of the file for the closing quote.
  bool closes(const YAML::Mark& mark) const {
    std::size_t i = offset(mark);
    while (i < text_.size() && (text_[i] == '&' || text_[i] == '!')) {  // anchor and tag stand before the quote
      i = std::min(text_.find_first_of(" \t\r\n", i), text_.size());
      i = std::min(text_.find_first_not_of(" \t\r\n", i), text_.size());
    }
    if (i >= text_.size() || (text_[i] != '"' && text_[i] != '\'')) return true;
    const char quote = text_[i];
    for (++i; i < text_.size(); ++i) {
      if (quote == '"' && text_[i] == '\\') {
        ++i;
      } else if (text_[i] == quote) {
        if (quote == '"' || i + 1 >= text_.size() || text_[i + 1] != quote) return true;
        ++i;
      }
    }
    return false;
  }

  bool has_at(const YAML::Mark& mark, std::string_view text) const { return text_.substr(offset(mark), text.size()) == text; }

 private:
  std::string_view text_;
  const Source& source_;
  std::vector<std::size_t> starts_;
};

/// Builds the tree from yaml-cpp's events, which tell everything that its own nodes hide: second documents, repeated keys,
/// aliases, tags.
class Builder final : public YAML::EventHandler {
 public:
  Builder(const Lines& lines, Report& report) : lines_(lines), report_(report) {}

  std::optional<Node> take() { return std::move(document_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) {
      report_.add(lines_.spot(mark), "a second document ('---'): a graph file has one");
      throw Stop{};
    }
  }
  void OnDocumentEnd() override {}

  void OnAnchor(const YAML::Mark&, const std::string& name) override { anchor_name_ = name; }

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { leaf(make(mark, "?"), anchor); }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, const std::string& value) override {
    Node node = make(mark, tag);
    node.kind = Node::Kind::scalar;
    node.text = value;
    node.quoted = tag != "?";
    node.exact = lines_.has_at(mark, value);
    if (node.quoted && !lines_.closes(mark)) {
      report_.add(node.spot, "not valid YAML: the closing quote is missing");
      throw Stop{};
    }
    if (value.find('\0') != std::string::npos) {
      report_.add(node.spot, "a NUL character in a text");
      node.broken = true;
    }
    leaf(std::move(node), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) {
      report_.add(lines_.spot(mark), fmt::format("alias '*{}' stands inside the value that it names", name_of(anchor)));
      throw Stop{};
    }
    count(found->second.nodes, lines_.spot(mark));
    Node copy = found->second.node;
    if (copy.depth() + static_cast<int>(open_.size()) > kDeepestNesting) too_deep(lines_.spot(mark));
    place(std::move(copy));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override {
    open(mark, tag, anchor, style, Node::Kind::list);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override {
    open(mark, tag, anchor, style, Node::Kind::map);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    Node node;
    YAML::anchor_t anchor = 0;
    std::optional<Node> key;                     ///< of a map, waiting for its value
    std::unordered_map<std::string, int> lines;  ///< of the keys so far
  };
  struct Anchored {
    Node node;
    std::size_t nodes;
  };

  std::string name_of(YAML::anchor_t anchor) const {
    const auto found = names_.find(anchor);
    return found == names_.end() ? "" : found->second;
  }

  [[noreturn]] void too_deep(const Spot& spot) {
    report_.add(spot, fmt::format("lists and maps are nested deeper than {} levels", kDeepestNesting));
    throw Stop{};
  }

  void count(std::size_t nodes, const Spot& spot) {
    nodes_ += nodes;
    if (nodes_ <= kMostNodes) return;
    report_.add(spot, fmt::format("the file has more than {} values, aliases expanded", kMostNodes));
    throw Stop{};
  }

  Node make(const YAML::Mark& mark, const std::string& tag) {
    Node node;
    node.spot = lines_.spot(mark);
    node.origin = node.spot.source;
    count(1, node.spot);
    if (!tag.empty() && tag != "?" && tag != "!")
      report_.add(node.spot, fmt::format("tag {}: a graph file has no tags, write the value alone", quote(tag)));
    return node;
  }

  void remember(YAML::anchor_t anchor) {
    if (anchor != 0) names_[anchor] = anchor_name_;
  }

  void leaf(Node node, YAML::anchor_t anchor) {
    remember(anchor);
    if (anchor != 0) anchors_.insert_or_assign(anchor, Anchored{node, 1});
    place(std::move(node));
  }

  void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YAML::EmitterStyle::value style,
            Node::Kind kind) {
    remember(anchor);
    Open opened{make(mark, tag), anchor, {}, {}};
    opened.node.kind = kind;
    opened.node.flow = style == YAML::EmitterStyle::Flow;
    if (static_cast<int>(open_.size()) >= kDeepestNesting) too_deep(opened.node.spot);
    open_.push_back(std::move(opened));
  }

  void close() {
    Open closed = std::move(open_.back());
    open_.pop_back();
    if (closed.anchor != 0) {
      const std::size_t nodes = closed.node.size();
      count(nodes, closed.node.spot);  // the copy that waits for aliases costs memory as well
      anchors_.insert_or_assign(closed.anchor, Anchored{closed.node, nodes});
    }
    place(std::move(closed.node));
  }

  void place(Node node) {
    if (open_.empty()) {
      document_ = std::move(node);
      return;
    }
    Open& parent = open_.back();
    if (parent.node.is_list()) {
      parent.node.items.push_back(std::move(node));
    } else if (!parent.key) {
      parent.key = std::move(node);
    } else {
      enter(parent, *parent.key, std::move(node));
      parent.key.reset();
    }
  }

  void enter(Open& map, const Node& key, Node value) {
    if (!key.is_scalar()) {
      report_.add(key.spot, fmt::format("a key must be a word, found {}", what(key)));
      return;
    }
    if (key.text == "<<" && !key.quoted) {
      report_.add(key.spot, "merge key '<<' is not supported: use 'variables' or 'include'");
      map.node.broken = true;
      return;
    }
    const auto [first, is_new] = map.lines.try_emplace(key.text, key.spot.line);
    if (!is_new) {
      report_.add(key.spot, fmt::format("key {} stands here twice (first in line {})", quote(key.text), first->second));
      return;
    }
    if (value.is_none()) value.spot = key.spot;
    map.node.entries.push_back({key.text, key.spot, std::move(value)});
  }

  const Lines& lines_;
  Report& report_;
  std::vector<Open> open_;
  std::optional<Node> document_;
  std::unordered_map<YAML::anchor_t, Anchored> anchors_;
  std::unordered_map<YAML::anchor_t, std::string> names_;
  std::string anchor_name_;
  std::size_t nodes_ = 0;
  int documents_ = 0;
};

/// yaml-cpp's words where they would puzzle an engineer.
std::string explain(const std::string& message) {
  static const std::unordered_map<std::string, std::string> kWords = {
      {YAML::ErrorMsg::END_OF_MAP_FLOW, "'}' or ',' is missing"},
      {YAML::ErrorMsg::END_OF_SEQ_FLOW, "']' or ',' is missing"},
      {YAML::ErrorMsg::END_OF_MAP, "a key, at the same indentation as the keys before it, is missing"},
      {YAML::ErrorMsg::END_OF_SEQ, "'- ', at the same indentation as the entries before it, is missing"},
      {YAML::ErrorMsg::EOF_IN_SCALAR, "the closing quote is missing"},
      {YAML::ErrorMsg::MAP_VALUE, "':' where no key can be (wrong indentation, or a text that needs quotes)"},
      {YAML::ErrorMsg::MAP_KEY, "a key where none can be (wrong indentation, or a text that needs quotes)"},
      {YAML::ErrorMsg::BLOCK_ENTRY, "'- ' where no list can be (wrong indentation)"},
      {YAML::ErrorMsg::FLOW_END, "']' or '}' without its beginning"},
      {YAML::ErrorMsg::TAB_IN_INDENTATION, "a tab in the indentation: use spaces"},
      {YAML::ErrorMsg::UNKNOWN_ANCHOR, "an alias for a value that is not there"},
      {YAML::ErrorMsg::UNKNOWN_TOKEN, "a character that begins no value: put the text in quotes"}};
  const auto found = kWords.find(message);
  return found == kWords.end() ? message : found->second;
}

}  // namespace

std::optional<Node> parse(const std::string& text, const Source& source, Report& report) {
  if (!is_readable(text, source, report)) return {};
  const bool has_mark = text.compare(0, 3, "\xEF\xBB\xBF") == 0;
  const std::string body = has_mark ? text.substr(3) : text;
  const Lines lines(body, source);
  Builder builder(lines, report);
  try {
    std::istringstream stream(body);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const Stop&) {
    return {};
  } catch (const YAML::Exception& error) {
    const bool variable = lines.line_of(error.mark).find("${") != std::string_view::npos;
    report.add(lines.spot(error.mark),
               "not valid YAML: " + explain(error.msg) + (variable ? " (inside {} and [], put \"${name}\" in quotes)" : ""));
    return {};
  }
  std::optional<Node> document = builder.take();
  if (!document) report.add({&source, 1, 1}, "the file is empty; a graph file begins with 'bodeflow: 1'");
  return document;
}

}  // namespace bodeflow::graph
