#include "score/answer.hpp"

#include <cmath>
#include <stdexcept>

namespace battery {
namespace {

/// "residual.coulomb_friction at bearing" is coulomb_friction.
std::string bare(const std::string& name) {
  const std::size_t dot = name.find("residual.") == 0 ? 9 : 0;
  return name.substr(dot, name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789", dot) - dot);
}

std::vector<std::string> bare(std::vector<std::string> names) {
  for (auto& name : names) name = bare(name);
  return names;
}

}  // namespace

Answer read_answer(const Json& file) {
  const Json& results = file["results"]["trace"];
  const Json& record = results.is_null() ? file : results;
  const Json& a = record["attributes"];
  const Json& arrays = record["arrays"];
  Answer r;
  r.message = file["message"].text();
  r.failed = a["verdict"].type() != Json::Type::text;
  if (r.failed) return r;
  r.verdict = a["verdict"].text();
  r.effects = bare(a["effects"].texts());
  r.equivalents = bare(a["equivalents"].texts());
  r.parameter_names = a["effect_parameter_names"].texts();
  r.parameter_units = a["effect_parameter_units"].texts();
  r.parameters = arrays["effect_parameters"]["data"].numbers();
  r.parameter_std = arrays["effect_parameter_std"]["data"].numbers();
  r.error_before = a["error_before"].number();
  r.error_after = a["error_after"].number();
  r.floor = a["noise_floor"].number();
  r.leak = a["leak"].truth() || r.verdict == "leak";
  r.at_floor = a["at_floor"].truth() || r.error_after <= a["noise_floor_99.9"].number();
  r.class_names = a["class_names"].texts();
  r.class_records = a["class_records"].texts();
  r.class_p = arrays["class_p_before"]["data"].numbers();
  r.candidate_names = bare(a["candidate_names"].texts());
  r.candidate_p = arrays["candidate_p"]["data"].numbers();
  return r;
}

std::vector<Truth> read_truth(const Json& file) {
  std::vector<Truth> all;
  for (const Json& c : file["cases"].list()) {
    Truth t{c["case"].text(), c["plant"].text(), c["class"].text(), c["effect"].text(), c["size"].number(), {}};
    if (t.number.empty() || (t.kind != "clean" && t.kind != "single" && t.kind != "outside"))
      throw std::runtime_error("the truth has a case without number or class");
    for (const Json& v : c["values"].list()) t.values.push_back({v["name"].text(), v["unit"].text(), v["value"].number()});
    all.push_back(t);
  }
  if (all.empty()) throw std::runtime_error("the truth has no cases");
  return all;
}

}  // namespace battery
