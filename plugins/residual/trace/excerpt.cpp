#include "trace/excerpt.hpp"

namespace bodeflow::residual {

std::optional<Excerpt> excerpt_of(const Bench& bench, const Examined& before) {
  Excerpt e;
  e.bench.select = bench.select;
  bool shorter = false;
  for (const auto& record : bench.fit) {
    auto part = record->excerpt();
    shorter = shorter || part;
    e.bench.fit.push_back(part ? std::move(part) : record);
  }
  if (!shorter) return {};
  const FitProblem problem(before.fit.model, e.bench.fit);
  Approach a;
  a.at = before.fit.at;
  a.residual = problem.residual(a.at);
  if (!a.residual.allFinite()) return {};
  a.cost = a.residual.squaredNorm();
  a.jacobian = problem.jacobian(a.at, a.residual);
  if (!a.jacobian.allFinite()) return {};
  e.before.fit = fit_at(problem, a);
  e.before.select = before.select;
  return e;
}

}  // namespace bodeflow::residual
