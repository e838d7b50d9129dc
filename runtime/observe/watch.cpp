#include "observe/watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "graph/blocks.hpp"
#include "graph/live_value.hpp"

namespace bodeflow::observe {
namespace {

using Refusal = tl::unexpected<std::string>;

/// As in result.json.
std::string key_of(const graph::Phase& phase, graph::End from) {
  const graph::Block& block = phase.blocks[static_cast<std::size_t>(from.block)];
  std::string key = phase.name.empty() ? block.name : phase.name + "." + block.name;
  if (from.port > 0) key += "." + block.type->port_at(BF_MESSAGE, BF_OUT, from.port).name;
  return key;
}

std::vector<std::string> names_of(const graph::Phase& phase) {
  std::vector<std::string> names;
  for (const auto& block : phase.blocks) names.push_back(block.name);
  return names;
}

/// Where a parameter lies, or why it can't be changed.
tl::expected<std::pair<int, int>, std::string> find_parameter(const graph::Phase& phase, const std::string& block,
                                                              const std::string& parameter) {
  const int b = phase.block_index(block);
  if (b < 0) return Refusal(fmt::format("unknown block '{}'{}", block, did_you_mean(block, names_of(phase))));
  const BlockDescription& type = *phase.blocks[static_cast<std::size_t>(b)].type;
  std::vector<std::string> live;
  for (const auto& p : type.parameters)
    if (p.live) live.push_back(p.name);
  const int p = type.parameter(parameter);
  if (p < 0) return Refusal(fmt::format("block '{}': unknown parameter '{}'{}", block, parameter, did_you_mean(parameter, live)));
  if (!type.parameters[static_cast<std::size_t>(p)].live)
    return Refusal(fmt::format("block '{}': parameter '{}' can't change while the graph runs; live parameters: {}", block,
                               parameter, live.empty() ? "none" : fmt::format("{}", fmt::join(live, ", "))));
  return std::pair{b, p};
}

}  // namespace

execute::Sink& Watch::begin_phase(const graph::Phase& phase, int repeat, const plan::Facts& facts, const plan::Plan& plan,
                                  execute::Sink& sink) {
  const std::lock_guard lock(mutex_);
  ++generation_;
  facts_ = std::make_shared<PhaseFacts>(PhaseFacts{&phase, repeat, false, facts, plan.partition_of, plan.chunk_s});
  taps_.push_back(std::make_unique<Tap>(phase, sink));
  state_ = {};
  values_.clear();
  counts_.clear();
  for (const auto& block : phase.blocks) {
    values_.push_back(block.parameters);
    counts_.emplace_back(static_cast<std::size_t>(block.type->count(BF_MESSAGE, BF_OUT)));
  }
  runs_ = true;
  return *taps_.back();
}

void Watch::end_phase() {
  const std::lock_guard lock(mutex_);
  collect();
  runs_ = false;
  for (std::size_t i = settled_; i < wishes_.size(); ++i) settle(wishes_[i], true);
  settled_ = wishes_.size();
}

void Watch::begin_sweep(const graph::Phase& phase, int repeat) {
  const std::lock_guard lock(mutex_);
  ++generation_;
  facts_ = std::make_shared<PhaseFacts>(PhaseFacts{&phase, repeat, true, {}, {}, 0.0});
  state_ = {};
  values_.clear();
  counts_.clear();
  runs_ = true;
}

void Watch::sweep_progress(const execute::Progress& runs) {
  const std::lock_guard lock(mutex_);
  if (facts_ && facts_->is_sweep) state_.progress = runs;
}

void Watch::add_record(const graph::Phase& phase, graph::End from, const SharedRecord& record) {
  const std::lock_guard lock(mutex_);
  keep(key_of(phase, from), {record, 0.0, 1});
}

void Watch::begins(execute::Access& access) {
  const std::lock_guard lock(mutex_);
  access_ = &access;
}

void Watch::ends() {
  const std::lock_guard lock(mutex_);
  collect();
  access_ = nullptr;
}

Look Watch::look() {
  const std::lock_guard lock(mutex_);
  collect();
  Look look{generation_, runs_, facts_, state_, values_, counts_, records_, {}};
  const std::size_t first = wishes_.size() - std::min(wishes_.size(), kMostShown);
  for (std::size_t i = first; i < wishes_.size(); ++i) look.changes.push_back(wishes_[i].change);
  return look;
}

tl::expected<void, std::string> Watch::ask(std::uint64_t generation, const std::string& block, const std::string& parameter,
                                           const std::string& value) {
  const std::lock_guard lock(mutex_);
  if (access_ == nullptr || generation != generation_) return Refusal("the phase that was shown does not run any more");
  const graph::Phase& phase = *facts_->phase;
  const auto place = find_parameter(phase, block, parameter);
  if (!place) return Refusal(place.error());
  const auto [b, p] = *place;
  const graph::Block& live = phase.blocks[static_cast<std::size_t>(b)];
  const ParameterDescription& description = live.type->parameters[static_cast<std::size_t>(p)];
  auto read = graph::read_live_value(description, fmt::format("block '{}': parameter '{}'", block, description.name), value,
                                     graph::own_unit(live));
  if (!read) return Refusal(read.error());
  collect();
  const auto waiting = std::count_if(wishes_.begin() + static_cast<std::ptrdiff_t>(settled_), wishes_.end(),
                                     [](const Wish& wish) { return wish.change.status == Change::Status::waiting; });
  if (waiting >= static_cast<std::ptrdiff_t>(kMostWaiting))
    return Refusal(fmt::format("{} changes wait to take effect, that many at most", waiting));
  if (wishes_.size() >= kMostChanges) return Refusal(fmt::format("{} changes in one run, that many at most", kMostChanges));
  Wish& wish = wishes_.emplace_back();
  wish.change.phase = phase.name;
  wish.change.repeat = facts_->repeat;
  wish.change.block = block;
  wish.change.parameter = description.name;
  wish.change.value = *read;
  wish.asked.block = b;
  wish.asked.parameter = p;
  wish.asked.value = std::move(*read);
  access_->ask(wish.asked);
  return {};
}

std::vector<Change> Watch::news() {
  const std::lock_guard lock(mutex_);
  collect();
  std::vector<Change> news;
  for (std::size_t i = told_; i < wishes_.size(); ++i) {
    Wish& wish = wishes_[i];
    if (wish.told || wish.change.status == Change::Status::waiting) continue;
    wish.told = true;
    news.push_back(wish.change);
  }
  while (told_ < wishes_.size() && wishes_[told_].told) ++told_;
  return news;
}

void Watch::collect() {
  if (access_ == nullptr) return;
  state_ = access_->state();
  for (std::size_t i = settled_; i < wishes_.size(); ++i) settle(wishes_[i], false);
  while (settled_ < wishes_.size() && wishes_[settled_].change.status != Change::Status::waiting) ++settled_;
  collect_values();
  collect_records();
}

void Watch::settle(Wish& wish, bool ended) {
  Change& change = wish.change;
  if (change.status != Change::Status::waiting) return;
  const std::int64_t position = wish.asked.position.load(std::memory_order_acquire);
  if (position >= 0) {
    change.status = Change::Status::taken;
    change.position = position;
    change.time_s = time_of(wish);
  } else if (position == execute::Asked::kRefused) {
    change.status = Change::Status::refused;
    change.refusal = wish.asked.refusal;
  } else if (ended) {
    change.status = Change::Status::missed;
  }
}

double Watch::time_of(const Wish& wish) const {
  const Rate& rate = facts_->facts.blocks[static_cast<std::size_t>(wish.asked.block)].firing_rate;
  const auto position = static_cast<double>(wish.change.position);
  return rate.num > 0 ? position * static_cast<double>(rate.den) / static_cast<double>(rate.num)
                      : position * facts_->facts.period.hz();
}

void Watch::collect_values() {
  for (std::size_t b = 0; b < values_.size(); ++b)
    for (std::size_t p = 0; p < values_[b].size(); ++p)
      if (auto taken = taps_.back()->take_value(static_cast<int>(b), static_cast<int>(p)))
        values_[b][p] = std::move(taken->value);
}

void Watch::collect_records() {
  for (std::size_t b = 0; b < counts_.size(); ++b)
    for (std::size_t port = 0; port < counts_[b].size(); ++port) {
      const graph::End from{static_cast<int>(b), static_cast<int>(port)};
      const auto sent = taps_.back()->take_record(from);
      if (!sent) continue;
      counts_[b][port] = sent->count;
      keep(key_of(*facts_->phase, from), *sent);
    }
}

void Watch::keep(const std::string& key, const Sent& sent) {
  auto known = std::find_if(records_.begin(), records_.end(), [&](const Record& record) { return record.key == key; });
  if (known == records_.end()) known = records_.insert(known, Record{key, {}, 0.0, 0, 0});
  known->record = sent.record;
  known->time_s = sent.time_s;
  known->count = sent.count;
  known->version = ++version_;
}

}  // namespace bodeflow::observe
