#include "report/graph_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "report/graph_layout.hpp"
#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr double kBoxHeight = 44.0;
constexpr double kRowGap = 18.0;
constexpr double kColumnGap = 46.0;
constexpr double kMargin = 10.0;
constexpr double kLoopGap = 16.0;  ///< between the paths that lead back below the boxes

struct Column {
  double left = 0.0;
  double width = 0.0;
};

double box_width(const graph::Block& block) {
  return std::max({text_width(block.name, 12.5), text_width(block.type->id, 11.0), 56.0}) + 18.0;
}

std::vector<Column> columns_of(const graph::Phase& phase, const GraphLayout& layout) {
  std::vector<Column> columns(static_cast<std::size_t>(layout.layers));
  for (std::size_t b = 0; b < phase.blocks.size(); ++b) {
    double& width = columns[static_cast<std::size_t>(layout.nodes[b].layer)].width;
    width = std::max(width, box_width(phase.blocks[b]));
  }
  double x = kMargin;
  for (auto& column : columns) {
    column.left = x;
    x += column.width + kColumnGap;
  }
  return columns;
}

class PhaseDrawing {
 public:
  PhaseDrawing(const graph::Phase& phase, const GraphLayout& layout, const std::vector<bool>& records)
      : phase_(phase), layout_(layout), records_(records), columns_(columns_of(phase, layout)) {
    for (const auto& node : layout.nodes) bottom_ = std::max(bottom_, node.y + 0.5 * node.height);
    bottom_ += kMargin;
  }

  Picture draw() {
    Picture picture{"Blocks and connections", "", 0.0, 0.0, {}};
    double below = bottom_;
    for (std::size_t e = 0; e < layout_.edges.size(); ++e) {
      const auto& edge = layout_.edges[e];
      if (edge.backward) below += kLoopGap;
      draw_wire(picture.body, edge.backward ? loop_path(edge, below) : forward_path(edge), records_[e]);
      draw_arrow(picture.body, edge);
    }
    for (std::size_t b = 0; b < phase_.blocks.size(); ++b) draw_box(picture.body, b);
    picture.width = columns_.back().left + columns_.back().width + kMargin + (below > bottom_ ? 14.0 : 0.0);
    picture.height = below + kMargin;
    return picture;
  }

 private:
  double y_of(int node) const { return kMargin + layout_.nodes[static_cast<std::size_t>(node)].y; }
  const Column& column_of(int node) const {
    return columns_[static_cast<std::size_t>(layout_.nodes[static_cast<std::size_t>(node)].layer)];
  }
  /// Where wires leave a box, and where they end.
  double right_of(int block) const { return column_of(block).left + box_width(phase_.blocks[static_cast<std::size_t>(block)]); }
  double left_of(int block) const { return column_of(block).left; }

  std::string forward_path(const LayoutEdge& edge) const {
    double x = right_of(edge.from), y = y_of(edge.from);
    std::string d = fmt::format("M{} {}", coordinate(x), coordinate(y));
    const auto curve = [&](double to_x, double to_y) {
      const double half = 0.5 * (to_x - x);
      d += fmt::format("C{} {} {} {} {} {}", coordinate(x + half), coordinate(y), coordinate(to_x - half), coordinate(to_y),
                       coordinate(to_x), coordinate(to_y));
      x = to_x;
      y = to_y;
    };
    for (std::size_t i = 1; i + 1 < edge.by.size(); ++i) {
      const Column& column = column_of(edge.by[i]);
      curve(column.left, y_of(edge.by[i]));
      x = column.left + column.width;
      d += fmt::format("L{} {}", coordinate(x), coordinate(y));
    }
    curve(left_of(edge.to) - 5.0, y_of(edge.to));
    return d;
  }

  /// Out at the right, back below all boxes, in from the left.
  std::string loop_path(const LayoutEdge& edge, double below) const {
    const double x1 = right_of(edge.from), y1 = y_of(edge.from) + 8.0, x2 = left_of(edge.to) - 5.0, y2 = y_of(edge.to);
    const double out = x1 + 14.0, in = left_of(edge.to) - 18.0;
    return fmt::format("M{0} {1}L{2} {1}L{2} {3}L{4} {3}L{4} {5}L{6} {5}", coordinate(x1), coordinate(y1), coordinate(out),
                       coordinate(below), coordinate(std::max(in, 3.0)), coordinate(y2), coordinate(x2));
  }

  static void draw_wire(Markup& body, const std::string& d, bool record) {
    body.single("path", {{"d", d}, {"class", record ? "wire records" : "wire"}});
  }

  void draw_arrow(Markup& body, const LayoutEdge& edge) const {
    const double x = left_of(edge.to), y = y_of(edge.to);
    body.single("path", {{"d", fmt::format("M{0} {1}L{2} {3}L{2} {4}Z", coordinate(x), coordinate(y), coordinate(x - 8.0),
                                           coordinate(y - 4.0), coordinate(y + 4.0))},
                         {"class", "arrow"}});
  }

  void draw_box(Markup& body, std::size_t b) const {
    const auto& block = phase_.blocks[b];
    const int node = static_cast<int>(b);
    const double left = left_of(node), width = box_width(block), middle = y_of(node);
    body.single(
        "rect",
        {{"x", left}, {"y", middle - 0.5 * kBoxHeight}, {"width", width}, {"height", kBoxHeight}, {"rx", 6.0}, {"class", "box"}});
    draw_text(body, left + 0.5 * width, middle - 3.0, block.name, Anchor::middle, "b");
    draw_text(body, left + 0.5 * width, middle + 13.0, block.type->id, Anchor::middle, "q");
  }

  const graph::Phase& phase_;
  const GraphLayout& layout_;
  const std::vector<bool>& records_;
  std::vector<Column> columns_;
  double bottom_ = 0.0;
};

}  // namespace

std::optional<Picture> draw_phase(const graph::Phase& phase) {
  if (phase.blocks.empty() || phase.blocks.size() > kMostBlocks) return {};
  std::vector<LayoutEdge> edges;
  std::vector<bool> records;
  std::set<std::tuple<int, int, bool>> seen;
  const auto add = [&](int from, int to, bool record) {
    if (!seen.insert({from, to, record}).second) return;
    edges.push_back({from, to, false, {}});
    records.push_back(record);
  };
  for (const auto& edge : phase.streams) add(edge.from.block, edge.to.block, false);
  for (const auto& edge : phase.messages) add(edge.from.block, edge.to.block, true);
  const GraphLayout layout = layout_graph(phase.blocks.size(), std::move(edges), kBoxHeight, kRowGap);
  Picture picture = PhaseDrawing(phase, layout, records).draw();
  if (!phase.name.empty()) picture.title += " of phase " + phase.name;
  picture.description =
      fmt::format("{} blocks with {} wires; streams are solid, records dashed.", phase.blocks.size(), layout.edges.size());
  return picture;
}

}  // namespace bodeflow::tools::report
