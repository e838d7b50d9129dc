#include "plan_record.hpp"

#include <bodeflow/error.hpp>
#include <bodeflow/record_builder.hpp>
#include <cmath>
#include <string>

#include "frequency_point.hpp"

namespace bodeflow::adaptive_control {
namespace {

double number_of(const RecordView& record, const char* name) {
  const auto value = record.number(name);
  if (!value || !std::isfinite(*value)) fail(std::string("plan: attribute '") + name + "' is no finite number");
  return *value;
}

}  // namespace

Plan read_plan(const RecordView& record, std::size_t points) {
  if (record.type() != "adaptive_plan") fail("plan: a record '" + std::string(record.type()) + "'; needed: adaptive_plan");
  Plan plan;
  if (const auto list = record.numbers("frequencies")) plan.omega.assign(list->begin(), list->end());
  if (plan.omega.size() != points) {
    fail("plan: " + std::to_string(plan.omega.size()) + " frequencies; this block has " + std::to_string(points));
  }
  const double delay = number_of(record, "delay");
  if (!(delay >= 0 && delay <= kMostDelay)) fail("plan: delay out of range");
  plan.delay = static_cast<int>(delay);
  plan.bandwidth = number_of(record, "bandwidth");
  if (!(plan.bandwidth > 0)) fail("plan: bandwidth is not above 0");
  plan.desired_delay_s = number_of(record, "desired_delay");
  plan.start_gain = number_of(record, "start_gain");
  return plan;
}

RecordBuilder write_plan(const Plan& plan) {
  RecordBuilder r("adaptive_plan");
  r.set("frequencies", plan.omega);
  r.set("delay", static_cast<double>(plan.delay));
  r.set("bandwidth", plan.bandwidth);
  r.set("desired_delay", plan.desired_delay_s);
  r.set("start_gain", plan.start_gain);
  return r;
}

}  // namespace bodeflow::adaptive_control
