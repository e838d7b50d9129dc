#include "motor_form.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace bodeflow::drive {
namespace {

struct Entry {
  const char* name;
  const char* unit;
  const char* doc;
};

const std::vector<Entry> kEntries = {
    {"rs", "ohm", "stator resistance"},
    {"rr", "ohm", "rotor resistance, referred to the stator"},
    {"ls", "H", "stator inductance"},
    {"lr", "H", "rotor inductance"},
    {"lm", "H", "mutual inductance"},
    {"stator_leakage", "H", "ls - lm, with rotor_leakage in place of ls and lr"},
    {"rotor_leakage", "H", "lr - lm"},
    {"alpha", "1/s", "rr / lr"},
    {"beta", "1/H", "lm / (sigma lr); beside lm_beta, or in its place with ls = lr assumed"},
    {"lm_beta", "1", "lm beta; without beta, ls = lr is assumed"},
    {"gamma", "1/s", "rs / sigma + alpha lm_beta"},
    {"sigma", "H", "transient inductance ls - lm^2 / lr"},
    {"rotor_resistance", "ohm", "of the inverse-Gamma form: rr (lm / lr)^2"},
    {"leakage", "H", "of the inverse-Gamma form: sigma"},
    {"magnetising", "H", "of the inverse-Gamma form: lm^2 / lr"},
};

std::vector<std::string> given_names(const Parameters& p) {
  std::vector<std::string> names;
  for (const Entry& e : kEntries) {
    if (p.has(e.name)) names.push_back(e.name);
  }
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

MotorParameters value_or_failure(const numerics::Expected<MotorParameters>& made) {
  if (!made) fail(made.error().text);
  return *made;
}

}  // namespace

void describe_motor_form(Describe& d) {
  for (const Entry& e : kEntries) d.optional<double>(e.name).unit(e.unit).above(0).doc(e.doc);
}

MotorParameters read_motor_form(const Parameters& p) {
  using Names = std::vector<std::string>;
  const Names given = given_names(p);
  const auto number = [&](const char* name) { return p.has(name) ? p.number(name) : 0.0; };
  if (given == Names{"rs", "rr", "ls", "lr", "lm"}) {
    return value_or_failure(checked({number("rs"), number("rr"), number("ls"), number("lr"), number("lm")}));
  }
  if (given == Names{"rs", "rr", "lm", "stator_leakage", "rotor_leakage"}) {
    return value_or_failure(
        from_t_form({number("rs"), number("rr"), number("stator_leakage"), number("rotor_leakage"), number("lm")}));
  }
  if (given == Names{"rs", "rotor_resistance", "leakage", "magnetising"}) {
    return value_or_failure(
        from_inverse_gamma({number("rs"), number("rotor_resistance"), number("leakage"), number("magnetising")}));
  }
  if (given == Names{"alpha", "beta", "gamma", "sigma"} || given == Names{"alpha", "lm_beta", "gamma", "sigma"} ||
      given == Names{"alpha", "beta", "lm_beta", "gamma", "sigma"}) {
    return value_or_failure(
        from_constants({number("alpha"), number("beta"), number("gamma"), number("sigma"), number("lm_beta")}));
  }
  fail("parameters of the motor: " + listed(given) +
       "; allowed: rs, rr, ls, lr, lm; or rs, rr, lm, stator_leakage, rotor_leakage; or alpha, gamma, sigma with beta or lm_beta "
       "or both; or rs, rotor_resistance, leakage, magnetising");
}

}  // namespace bodeflow::drive
