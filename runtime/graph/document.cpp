#include "graph/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "graph/guard.hpp"
#include "graph/parse.hpp"

namespace bodeflow::graph {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 3> kMergedMaps = {"requires", "variables", "blocks"};
constexpr std::array<std::string_view, 3> kMergedLists = {"connections", "schedule", "limits"};

std::string absolute(const std::string& file) {
  std::error_code error;
  const fs::path path = fs::absolute(file, error);
  return (error ? fs::path(file) : path).lexically_normal().string();
}

class Assembler {
 public:
  Assembler(Document& document, Report& report) : document_(document), report_(report) {}

  /// The tree of a text with its includes merged in. `file` is how messages name it.
  std::optional<Node> tree(const std::string& text, const std::string& file, bool included) {
    const std::string path = absolute(file);
    const Source& source = document_.add_source(file, fs::path(path).parent_path().string());
    std::optional<Node> root = parse(text, source, report_);
    if (!root) return {};
    if (!root->is_map()) {
      report_.add(root->spot, fmt::format("a graph file is a map of keys, found {}", what(*root)));
      return {};
    }
    if (included) check_included(*root);
    active_.push_back({path, file});
    const bool complete = merge_includes(*root);
    active_.pop_back();
    if (!complete) return {};
    return root;
  }

 private:
  struct Active {
    std::string path, shown;
  };

  void check_included(Node& root) {
    std::erase_if(root.entries, [&](const Entry& e) {
      const auto is = [&](std::string_view key) { return key == e.key; };
      if (is("bodeflow") || is("include")) return false;
      if (std::any_of(kMergedMaps.begin(), kMergedMaps.end(), is)) return not_a(e, Node::Kind::map);
      if (std::any_of(kMergedLists.begin(), kMergedLists.end(), is)) return not_a(e, Node::Kind::list);
      report_.add(e.spot, fmt::format("key {} can't stand in an included file; allowed: bodeflow, include, requires, variables, "
                                      "blocks, connections, schedule, limits",
                                      quote(e.key)));
      return true;
    });
  }

  bool not_a(const Entry& e, Node::Kind kind) {
    if (e.value.kind == kind) return false;
    if (!e.value.is_none())
      report_.add(e.value.spot,
                  fmt::format("{}: found {}, allowed: {}", e.key, what(e.value), kind == Node::Kind::map ? "a map" : "a list"));
    return true;
  }

  bool merge_includes(Node& root) {
    const auto where = std::find_if(root.entries.begin(), root.entries.end(), [](const Entry& e) { return e.key == "include"; });
    if (where == root.entries.end()) return true;
    const Node include = std::move(where->value);
    const auto position = where - root.entries.begin();
    root.entries.erase(where);
    if (!include.is_list()) {
      report_.add(include.spot, fmt::format("include: found {}, allowed: a list of files", what(include)));
      return false;
    }
    bool complete = true;
    Node all;
    all.kind = Node::Kind::map;
    for (const auto& item : include.items) {
      std::optional<Node> tree = included_tree(item);
      if (!tree) complete = false;
      if (tree) append(all, std::move(*tree));
    }
    for (auto& e : all.entries) {
      if (Node* own = root.find(e.key)) {
        if (own->is_none()) own->kind = e.value.kind;
        if (own->kind != e.value.kind) continue;  // reported with the file's own keys
        append(e.value, std::move(*own), e.key);
        *own = std::move(e.value);
      } else {
        root.entries.insert(root.entries.begin() + position, std::move(e));
      }
    }
    return complete;
  }

  std::optional<Node> included_tree(const Node& item) {
    if (!item.is_scalar()) {
      report_.add(item.spot, fmt::format("include: found {}, allowed: the name of a file", what(item)));
      return {};
    }
    if (item.text.find("${") != std::string::npos) {
      report_.add(item.spot, "include: a variable can't stand in the name of a file");
      return {};
    }
    const fs::path beside = fs::path(item.spot.source->file).parent_path();
    const std::string shown = (beside / item.text).lexically_normal().string();
    const std::string path = absolute(shown);
    const auto loop = std::find_if(active_.begin(), active_.end(), [&](const Active& a) { return a.path == path; });
    if (loop != active_.end()) {
      std::string cycle;
      for (auto a = loop; a != active_.end(); ++a) cycle += a->shown + " -> ";
      report_.add(item.spot, "files include each other: " + cycle + shown);
      return {};
    }
    const auto [first, is_new] = included_.try_emplace(path, item.spot.place());
    if (!is_new) {
      report_.add(item.spot, fmt::format("{} is included twice (first at {}:{}:{})", quote(shown), first->second.file,
                                         first->second.line, first->second.column));
      return {};
    }
    if (active_.size() >= static_cast<std::size_t>(kDeepestNesting)) {
      report_.add(item.spot, fmt::format("files include each other deeper than {} levels", kDeepestNesting));
      return {};
    }
    const auto text = read_file(shown, item.spot, report_);
    if (!text) return {};
    return tree(*text, shown, true);
  }

  /// Adds the sections of an included file to those collected so far.
  void append(Node& all, Node tree) {
    for (auto& e : tree.entries) {
      if (e.key == "bodeflow") continue;
      if (Node* known = all.find(e.key)) {
        append(*known, std::move(e.value), e.key);
      } else {
        all.entries.push_back(std::move(e));
      }
    }
  }

  void append(Node& section, Node more, const std::string& name) {
    section.flow = section.flow && more.flow;
    for (auto& item : more.items) section.items.push_back(std::move(item));
    for (auto& e : more.entries) {
      if (const Entry* first = section.entry(e.key)) {
        const Place place = first->spot.place();
        report_.add(e.spot, fmt::format("{}: {} is there twice (first at {}:{}:{})", name, quote(e.key), place.file, place.line,
                                        place.column));
      } else {
        section.entries.push_back(std::move(e));
      }
    }
  }

  Document& document_;
  Report& report_;
  std::vector<Active> active_;
  std::map<std::string, Place> included_;
};

}  // namespace

const Source& Document::add_source(std::string file, std::string folder, bool command_line) {
  return sources.emplace_back(Source{std::move(file), std::move(folder), command_line});
}

std::optional<std::string> read_file(const std::string& file, const Spot& asked_for, Report& report) {
  const auto refuse = [&](const std::string& reason) {
    report.add(asked_for, fmt::format("can't read {}: {}", quote(file), reason));
    return std::nullopt;
  };
  std::error_code error;
  const auto status = fs::status(file, error);
  if (!fs::exists(status)) return refuse("there is no such file");
  if (fs::is_directory(status)) return refuse("it is a folder");
  if (!fs::is_regular_file(status)) return refuse("it is not a regular file");
  const auto size = fs::file_size(file, error);
  if (!error && size > kLargestFile) return refuse(fmt::format("it has {} bytes, allowed: {}", size, kLargestFile));
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return refuse("permission denied");
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (stream.bad()) return refuse("reading failed");
  return text;
}

bool assemble(const std::string& text, const std::string& file, Document& document, Report& report) {
  Assembler assembler(document, report);
  std::optional<Node> root = assembler.tree(text, file, false);
  if (!root) return false;
  document.root = std::move(*root);
  return true;
}

}  // namespace bodeflow::graph
