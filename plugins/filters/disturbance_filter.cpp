#include "disturbance_filter.hpp"

#include <bodeflow/numerics/iir_design.hpp>
#include <string>

#include "notch_section.hpp"

namespace bodeflow::filters {
namespace {

using numerics::Expected;
using numerics::refused;
using numerics::Sections;

std::string wrong(const DisturbanceDesign& d) {
  if (d.steps < 0 || d.steps > 3) return "steps is " + std::to_string(d.steps) + "; allowed: 0 to 3";
  if (d.order < 0 || d.order > numerics::kMostFilterOrder) {
    return "order is " + std::to_string(d.order) + "; allowed: 0 to " + std::to_string(numerics::kMostFilterOrder);
  }
  if (d.steps == 0 && d.sinusoids.empty() && d.order == 0) return "steps 0, order 0 and no sinusoid: there is nothing to filter";
  if (d.steps > 0 && d.order > 0 && !(d.low < d.high)) return "low must lie below high";
  return "";
}

Expected<Sections> classical(numerics::FilterKind kind, numerics::Pass pass, int order, double edge) {
  numerics::IirDesign d;
  d.kind = kind;
  d.pass = pass;
  d.order = order;
  d.edges[0] = edge;
  auto filter = numerics::design_iir(d);
  if (!filter) return tl::make_unexpected(filter.error());
  return std::move(filter->sections);
}

}  // namespace

Expected<Sections> disturbance_filter(const DisturbanceDesign& d) {
  if (std::string reason = wrong(d); !reason.empty()) return refused(std::move(reason));
  Sections all;
  const auto add = [&](Expected<Sections> part) {
    if (part) all.insert(all.end(), part->begin(), part->end());
    return part ? Expected<void>() : Expected<void>(tl::make_unexpected(part.error()));
  };
  using numerics::FilterKind;
  if (d.steps > 0) {
    const auto added = add(classical(FilterKind::butterworth, numerics::Pass::high, d.steps, d.low));
    if (!added) return tl::make_unexpected(added.error());
  }
  for (const double w_h : d.sinusoids) {
    const auto notch = notch_section(w_h, d.width);
    if (!notch) return tl::make_unexpected(notch.error());
    all.push_back(*notch);
  }
  if (d.order > 0) {
    const auto kind = d.bessel ? FilterKind::bessel : FilterKind::butterworth;
    const auto added = add(classical(kind, numerics::Pass::low, d.order, d.high));
    if (!added) return tl::make_unexpected(added.error());
  }
  return all;
}

}  // namespace bodeflow::filters
