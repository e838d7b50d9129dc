#include "trace/binding.hpp"

#include <algorithm>
#include <map>

namespace bodeflow::residual {
namespace {

bool at_place(const EffectDescription& what) { return what.acts == Acts::law || what.acts == Acts::immittance; }

bool knows(const EffectDescription& what, const Place& place) {
  return std::find(what.kinds.begin(), what.kinds.end(), place.kind) != what.kinds.end();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : ", ") + w;
  return text;
}

/// Why no effect of that kind can be simulated with these records and that base.
std::string not_simulated(const EffectDescription& what, const BaseModel& base, const Measurements& records) {
  const bool response =
      std::any_of(records.begin(), records.end(), [](const auto& r) { return r->facts().sample_rate_hz <= 0.0; });
  if (response && (!what.linear() || what.acts == Acts::tone))
    return "needs records in time: a measured response holds only what is linear";
  if (what.acts == Acts::law && !base.has_state_space())
    return "needs a base model that can be simulated: this one is given by its response alone";
  return {};
}

class Binder {
 public:
  Binder(const JointModel& model, const std::vector<Eigen::VectorXd>& values, const Measurements& records)
      : model_(model), values_(values), records_(records), places_(model.base->places()) {}

  void add(const CatalogueEntry& entry, std::vector<Bound>& all) {
    if (!at_place(entry.what)) return add_at(entry, Addition::kNoPlace, all);
    bool some = false;
    for (std::size_t p = 0; p < places_.size(); ++p) {
      if (!knows(entry.what, places_[p])) continue;
      some = true;
      add_at(entry, p, all);
    }
    if (some) return;
    Bound none;
    none.addition.what = entry.what;
    none.addition.effect = entry.effect;
    none.addition.label = entry.what.name();
    none.refusal = places_.empty() ? "acts inside the plant, of which this base model knows input and output alone"
                                   : "acts at places of kind " + joined(entry.what.kinds) + ", which the base model has not";
    all.push_back(std::move(none));
  }

 private:
  void add_at(const CatalogueEntry& entry, std::size_t place, std::vector<Bound>& all) {
    for (const Addition& a : model_.additions)
      if (a.what.id == entry.what.id && a.place == place) return;
    Bound b;
    b.addition.what = entry.what;
    b.addition.effect = entry.effect;
    b.addition.place = place;
    b.refusal = not_simulated(entry.what, *model_.base, records_);
    if (b.refusal.empty()) {
      const Situation& s = situation(place);
      b.refusal = entry.effect->refuses(s);
      b.addition = bound(entry, *model_.base, place, s);
      if (b.refusal.empty() && entry.effect->starts(s).empty()) b.refusal = "finds nothing in the records to start from";
    } else {
      b.addition.label = entry.what.name();
    }
    all.push_back(std::move(b));
  }

  const Situation& situation(std::size_t place) {
    const auto found = situations_.find(place);
    if (found != situations_.end()) return found->second;
    Situation s;
    if (place != Addition::kNoPlace) s.place = places_[place];
    for (std::size_t r = 0; r < records_.size(); ++r) records_[r]->say(model_, values_[r], place, s);
    return situations_[place] = std::move(s);
  }

  const JointModel& model_;
  const std::vector<Eigen::VectorXd>& values_;
  const Measurements& records_;
  std::vector<Place> places_;
  std::map<std::size_t, Situation> situations_;
};

}  // namespace

Addition bound(const CatalogueEntry& entry, const BaseModel& base, std::size_t place, Situation situation) {
  Addition a;
  a.what = entry.what;
  a.effect = entry.effect;
  a.place = place;
  a.parameters = entry.effect->parameters(situation);
  const std::vector<Place> places = base.places();
  const auto known = std::count_if(places.begin(), places.end(), [&](const Place& p) { return knows(entry.what, p); });
  a.label = place != Addition::kNoPlace && known > 1 ? entry.what.name() + " at " + places[place].name : entry.what.name();
  a.situation = std::move(situation);
  return a;
}

std::vector<Bound> bind_all(const Catalogue& catalogue, const JointModel& model, const std::vector<Eigen::VectorXd>& values,
                            const Measurements& records) {
  Binder binder(model, values, records);
  std::vector<Bound> all;
  for (const CatalogueEntry& entry : catalogue) binder.add(entry, all);
  return all;
}

}  // namespace bodeflow::residual
