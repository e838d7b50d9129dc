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
constexpr double kNoteHeight = 16.0;  ///< of the third line of a box
constexpr double kNoteWidth = 104.0;
constexpr double kMargin = 10.0;
constexpr double kLoopGap = 14.0;  ///< between the ways that lead back beside the boxes
constexpr double kArrow = 8.0;

double box_width(const graph::Block& block, bool notes) {
  return std::max({text_width(block.name, 12.5), text_width(block.type->id, 11.0), notes ? kNoteWidth : 56.0}) + 18.0;
}

/// Drawn in two directions: `along` the layers (to the right, or down) and `across` them.
class PhaseDrawing {
 public:
  PhaseDrawing(const graph::Phase& phase, std::vector<LayoutEdge> edges, bool down, bool notes)
      : phase_(phase), down_(down), notes_(notes), height_(notes ? kBoxHeight + kNoteHeight : kBoxHeight) {
    std::vector<double> sizes;
    for (const auto& block : phase.blocks) sizes.push_back(down ? box_width(block, notes) : height_);
    layout_ = layout_graph(sizes, std::move(edges), down ? 14.0 : 18.0);
    lengths_.assign(static_cast<std::size_t>(layout_.layers), 0.0);
    for (std::size_t b = 0; b < phase.blocks.size(); ++b) {
      double& length = lengths_[static_cast<std::size_t>(layout_.nodes[b].layer)];
      length = std::max(length, length_of_box(b));
    }
    double at = kMargin;
    for (const double length : lengths_) {
      starts_.push_back(at);
      at += length + (down ? 30.0 : 46.0);
    }
    for (const auto& node : layout_.nodes) across_ = std::max(across_, kMargin + node.middle + 0.5 * node.size);
  }

  Picture draw(const std::vector<bool>& records) const {
    Picture picture{"Blocks and connections", "", 0.0, 0.0, {}};
    double beside = across_;
    for (std::size_t e = 0; e < layout_.edges.size(); ++e) {
      const auto& edge = layout_.edges[e];
      if (edge.backward) beside += kLoopGap;
      picture.body.single("path", {{"d", edge.backward ? loop_path(edge, beside) : forward_path(edge)},
                                   {"class", records[e] ? "wire records" : "wire"}});
      draw_arrow(picture.body, edge);
    }
    for (std::size_t b = 0; b < phase_.blocks.size(); ++b) draw_box(picture.body, b);
    const double along = starts_.back() + lengths_.back() + kMargin + (beside > across_ ? kLoopGap : 0.0);
    picture.width = down_ ? beside + kMargin : along;
    picture.height = down_ ? along : beside + kMargin;
    return picture;
  }

 private:
  double length_of_box(std::size_t b) const { return down_ ? height_ : box_width(phase_.blocks[b], notes_); }
  std::size_t layer(int node) const { return static_cast<std::size_t>(layout_.nodes[static_cast<std::size_t>(node)].layer); }
  double start(int node) const { return starts_[layer(node)]; }
  double end(int box) const { return start(box) + length_of_box(static_cast<std::size_t>(box)); }
  double middle(int node) const { return kMargin + layout_.nodes[static_cast<std::size_t>(node)].middle; }

  std::string point(double along, double across) const {
    return down_ ? coordinate(across) + " " + coordinate(along) : coordinate(along) + " " + coordinate(across);
  }

  std::string forward_path(const LayoutEdge& edge) const {
    double along = end(edge.from), across = middle(edge.from);
    std::string d = "M" + point(along, across);
    const auto curve = [&](double to_along, double to_across) {
      const double half = 0.5 * (to_along - along);
      d += fmt::format("C{} {} {}", point(along + half, across), point(to_along - half, to_across), point(to_along, to_across));
      along = to_along;
      across = to_across;
    };
    for (std::size_t i = 1; i + 1 < edge.by.size(); ++i) {
      const int bend = edge.by[i];
      curve(start(bend), middle(bend));
      along = start(bend) + lengths_[layer(bend)];
      d += "L" + point(along, across);
    }
    curve(start(edge.to) - 5.0, middle(edge.to));
    return d;
  }

  /// Out at the end, back beside all boxes, in at the start.
  std::string loop_path(const LayoutEdge& edge, double beside) const {
    const double from = middle(edge.from) + 8.0, to = middle(edge.to) + 8.0;
    const double out = end(edge.from) + 12.0, in = std::max(start(edge.to) - 17.0, 2.0);
    return fmt::format("M{}L{}L{}L{}L{}L{}", point(end(edge.from), from), point(out, from), point(out, beside), point(in, beside),
                       point(in, to), point(start(edge.to) - 5.0, to));
  }

  void draw_arrow(Markup& body, const LayoutEdge& edge) const {
    const double across = middle(edge.to) + (edge.backward ? 8.0 : 0.0), tip = start(edge.to);
    body.single("path", {{"d", fmt::format("M{}L{}L{}Z", point(tip, across), point(tip - kArrow, across - 4.0),
                                           point(tip - kArrow, across + 4.0))},
                         {"class", "arrow"}});
  }

  void draw_box(Markup& body, std::size_t b) const {
    const auto& block = phase_.blocks[b];
    const int node = static_cast<int>(b);
    const double width = box_width(block, notes_);
    const double x = down_ ? middle(node) : start(node) + 0.5 * width, top = (down_ ? start(node) : middle(node) - 0.5 * height_);
    const double y = top + 0.5 * kBoxHeight;
    body.single("rect",
                {{"x", x - 0.5 * width}, {"y", top}, {"width", width}, {"height", height_}, {"rx", 6.0}, {"class", "box"}});
    draw_text(body, x, y - 3.0, block.name, Anchor::middle, "b");
    draw_text(body, x, y + 13.0, block.type->id, Anchor::middle, "q");
    if (!notes_) return;
    body.element("text",
                 {{"x", x}, {"y", y + 29.0}, {"class", "t"}, {"text-anchor", "middle"}, {"data-block", std::to_string(b)}}, "");
  }

  const graph::Phase& phase_;
  bool down_;
  bool notes_;
  double height_;  ///< of a box
  GraphLayout layout_;
  std::vector<double> starts_;   ///< of each layer, along
  std::vector<double> lengths_;  ///< of its longest box
  double across_ = 0.0;          ///< where the boxes end
};

}  // namespace

std::optional<Picture> draw_phase(const graph::Phase& phase, double width, bool notes) {
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
  Picture picture = PhaseDrawing(phase, edges, false, notes).draw(records);
  if (picture.width > width) picture = PhaseDrawing(phase, edges, true, notes).draw(records);
  if (!phase.name.empty()) picture.title += " of phase " + phase.name;
  picture.description =
      fmt::format("{} blocks with {} wires; streams are solid, records dashed.", phase.blocks.size(), edges.size());
  return picture;
}

}  // namespace bodeflow::tools::report
