#include <algorithm>
#include <bodeflow/testing/conformance.hpp>

#include "checks.hpp"
#include "descriptor_check.hpp"
#include "feed_settings.hpp"
#include "part_checks.hpp"
#include "plugin_file.hpp"

namespace bodeflow::testing {
namespace {

constexpr const char* kSoundDescriptor = "has a sound descriptor";
constexpr const char* kSetUp = "can be set up";

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& t : texts) all += (all.empty() ? "" : "; ") + t;
  return all;
}

std::string text_of(const Setting& setting) {
  std::vector<std::string> parts;
  for (const auto& [name, value] : setting) parts.push_back(name + " = " + value);
  std::string text;
  for (const std::string& p : parts) text += (text.empty() ? "" : ", ") + p;
  return text;
}

/// The case of a setting. Throws Failure for a parameter that does not exist or a value that it can't have.
Case make_case(const bf_factory& factory, const Setting& setting) {
  Case c;
  c.factory = &factory;
  c.block = static_cast<const bf_block_descriptor*>(factory.descriptor);
  for (std::uint32_t i = 0; i < c.block->parameter_count; ++i) c.values.push_back(fallback_of(*c.block->parameters[i]));
  for (const auto& [name, value] : setting) {
    if (!name.empty() && name[0] == '@') {
      set_feed(c.feed, *c.block, name, value);
      continue;
    }
    std::uint32_t index = 0;
    while (index < c.block->parameter_count && name != c.block->parameters[index]->name) ++index;
    if (index == c.block->parameter_count) fail("unknown parameter '" + name + "'");
    auto parsed = parse_parameter(*c.block->parameters[index], value);
    if (!parsed) fail(parsed.error().text);
    c.values[index] = *parsed;
  }
  for (std::uint32_t i = 0; i < c.block->parameter_count; ++i) {
    const bf_parameter_descriptor& p = *c.block->parameters[i];
    if ((p.flags & BF_PARAMETER_REQUIRED) != 0 && !c.values[i].given) {
      throw Skip{std::string("parameter '") + p.name + "' is required"};
    }
  }
  return c;
}

bool needs_setting(const bf_block_descriptor& block) {
  return std::any_of(block.parameters, block.parameters + block.parameter_count,
                     [](const bf_parameter_descriptor* p) { return (p->flags & BF_PARAMETER_REQUIRED) != 0; });
}

/// Tests one plugin; collects into the report.
class Suite {
 public:
  Suite(Report& report, const Options& options) : report_(report), options_(options) {}

  void run() {
    if (!check("", "", "has an ELF note that tells what it is", [&](const Step&) { read_note(report_.file); })) return;
    if (!check("", "", "loads and gives its factories", [&](const Step&) { load_plugin(report_.file); })) return;
    const LoadedPlugin plugin = load_plugin(report_.file);
    TestHost::offer_parts(plugin);
    check("", "", "has a sound entry", [&](const Step&) {
      auto problems = plugin_problems(*plugin.plugin, plugin.factories, plugin.count);
      const bf_elf_note note = read_note(report_.file);
      if (note.magic != plugin.plugin->magic || note.abi_major != plugin.plugin->abi_major ||
          note.abi_minor != plugin.plugin->abi_minor || std::string(note.name) != plugin.plugin->name ||
          std::string(note.version) != plugin.plugin->version) {
        problems.push_back("ELF note and entry differ");
      }
      if (!problems.empty()) fail(joined(problems));
    });
    know_all_names(plugin);
    for (std::uint32_t i = 0; i < plugin.count; ++i) {
      const bf_factory& f = *plugin.factories[i];
      if (!options_.block.empty() && options_.block != f.id) continue;
      const std::size_t before = report_.checks.size();
      if (std::string_view(f.kind) == "block") block(f);
      if (std::string_view(f.kind) == "block") demand_a_test(f, before);
      if (std::string_view(f.kind) == "effect") effect(f);
      if (std::string_view(f.kind) == "base_model") base_model(f);
    }
  }

 private:
  bool check(const std::string& id, const std::string& setting, const std::string& name,
             const std::function<void(const Step&)>& work) {
    return note(id, setting, name, judge(work, options_.isolate, options_.timeout_s));
  }

  /// What the options name is there: a slip of the pen would test nothing, and pass.
  void know_all_names(const LoadedPlugin& plugin) {
    std::vector<std::string> wanted;
    if (!options_.block.empty()) wanted.push_back(options_.block);
    for (const auto& [id, settings] : options_.settings) wanted.push_back(id);
    std::string there;
    for (std::uint32_t i = 0; i < plugin.count; ++i) there += (i == 0 ? "" : ", ") + std::string(plugin.factories[i]->id);
    for (const std::string& id : wanted) {
      const auto is = [&](const bf_factory* f) { return id == f->id; };
      if (std::any_of(plugin.factories, plugin.factories + plugin.count, is)) continue;
      note(id, "", "is in the plugin", {Status::fail, "the plugin has " + there});
    }
  }

  /// A block whose every setting refuses to run was not tested: no pass. A device or network may not be there.
  void demand_a_test(const bf_factory& factory, std::size_t first) {
    const auto* descriptor = static_cast<const bf_block_descriptor*>(factory.descriptor);
    if (descriptor == nullptr) return;
    for (const char* outside : {"device", "network"})
      if (std::string(descriptor->roles).find(outside) != std::string::npos) return;
    std::string reason;
    for (std::size_t i = first; i < report_.checks.size(); ++i) {
      const Check& c = report_.checks[i];
      if (c.status == Status::fail) return;
      if (c.status == Status::pass && c.name != kSoundDescriptor && c.name != kSetUp) return;
      if (c.status == Status::skip && reason.empty()) reason = c.reason;
    }
    note(factory.id, "", "runs in some setting",
         {Status::fail, "it refused all of them: " + reason + "; give one in a settings file"});
  }

  bool note(const std::string& id, const std::string& setting, const std::string& name, Verdict verdict) {
    if (verdict.status == Status::skip && verdict.reason.empty()) return true;
    report_.checks.push_back({id, setting, name, verdict.status, std::move(verdict.reason)});
    return report_.checks.back().status == Status::pass;
  }

  void block(const bf_factory& factory) {
    const bool sound = check(factory.id, "", kSoundDescriptor, [&](const Step&) {
      const auto problems = descriptor_problems(factory);
      if (!problems.empty()) fail(joined(problems));
    });
    const auto* descriptor = static_cast<const bf_block_descriptor*>(factory.descriptor);
    if (!sound && descriptor == nullptr) return;
    std::vector<Setting> settings;
    if (const auto given = options_.settings.find(factory.id); given != options_.settings.end()) settings = given->second;
    if (settings.empty() || !needs_setting(*descriptor)) settings.insert(settings.begin(), Setting{});
    const Setting base = settings.front();
    for (const Setting& setting : settings) test(factory, setting, true);
    for (const Setting& setting : variants(*descriptor, base)) test(factory, setting, false);
  }

  void effect(const bf_factory& factory) {
    const bool sound = check(factory.id, "", kSoundDescriptor, [&](const Step&) {
      const auto problems = effect_problems(factory);
      if (!problems.empty()) fail(joined(problems));
    });
    if (!sound) return;
    for (const PartCheck& one : effect_checks(factory)) check(factory.id, "", one.name, one.run);
  }

  void base_model(const bf_factory& factory) {
    const bool sound = check(factory.id, "", kSoundDescriptor, [&](const Step&) {
      const auto problems = descriptor_problems(factory);
      if (!problems.empty()) fail(joined(problems));
    });
    if (!sound) return;
    std::vector<Setting> settings;
    if (const auto given = options_.settings.find(factory.id); given != options_.settings.end()) settings = given->second;
    const bool needs = needs_setting(*static_cast<const bf_block_descriptor*>(factory.descriptor));
    if (settings.empty() || !needs) settings.insert(settings.begin(), Setting{});
    for (const Setting& setting : settings) {
      const std::string text = text_of(setting);
      Case c;
      if (!check(factory.id, text, kSetUp, [&](const Step&) { make_case(factory, setting); })) continue;
      for (const PartCheck& one : base_checks(factory, make_case(factory, setting).values))
        check(factory.id, text, one.name, one.run);
    }
  }

  /// The base setting with one switch or choice turned, more channels, complex samples, unconnected inputs.
  static std::vector<Setting> variants(const bf_block_descriptor& block, const Setting& base) {
    std::vector<Setting> list;
    const auto add = [&](const std::string& name, const std::string& value) {
      Setting s;
      for (const auto& pair : base) {
        if (pair.first != name) s.push_back(pair);
      }
      s.emplace_back(name, value);
      if (s != base) list.push_back(std::move(s));
    };
    bool streams_in = false, any = false;
    for (std::uint32_t i = 0; i < block.port_count; ++i) {
      const bf_port_descriptor& p = *block.ports[i];
      streams_in = streams_in || (p.kind == BF_STREAM && p.direction == BF_IN);
      any = any || (p.kind == BF_STREAM && p.direction == BF_IN && p.element == BF_ANY);
    }
    if (streams_in) add("@channels", "3");
    if (any) add("@element", "c64");
    for (std::uint32_t i = 0; i < block.parameter_count; ++i) {
      const bf_parameter_descriptor& p = *block.parameters[i];
      if (p.type == BF_BOOL) add(p.name, p.fallback.rows != 0 && p.fallback.integer != 0 ? "false" : "true");
      for (std::uint32_t k = 0; p.type == BF_CHOICE && k < p.choice_count; ++k) {
        if (p.fallback.rows == 0 || std::string(p.choices[k]) != p.fallback.strings[0]) add(p.name, p.choices[k]);
      }
    }
    return list;
  }

  /// Runs every check of one setting. A setting that the block itself refuses is skipped with the block's words.
  void test(const bf_factory& factory, const Setting& setting, bool with_parameters) {
    const std::string text = text_of(setting);
    Case c;
    const bool usable = check(factory.id, text, kSetUp, [&](const Step& step) {
      c = make_case(factory, setting);
      set_up(c, step);
    });
    if (!usable) return;
    try {
      c = make_case(factory, setting);
    } catch (const std::exception&) {
      return;
    }
    for (const BlockCheck& one : case_checks()) run(factory.id, text, one, c);
    if (!with_parameters) return;
    for (const BlockCheck& one : parameter_checks(*c.block)) run(factory.id, text, one, c);
    test_unconnected(factory.id, text, c);
  }

  void run(const std::string& id, const std::string& text, const BlockCheck& one, const Case& c) {
    const unsigned timeout_s = one.timeout_s == 0 ? options_.timeout_s : std::min(one.timeout_s, options_.timeout_s);
    Verdict verdict = judge([&](const Step& step) { one.run(c, step); }, options_.isolate, timeout_s);
    if (verdict.timed_out && !one.hang_is_failure) verdict.status = Status::skip;
    note(id, text, one.name, std::move(verdict));
  }

  static void set_up(const Case& c, const Step& step) {
    try {
      Rig rig(c);
      step("configure");
      rig.configure();
      step("resolve");
      rig.resolve();
      step("activate");
      rig.activate(1000);
    } catch (const Failure& refused) {
      throw Skip{refused.what()};
    }
  }

  void test_unconnected(const std::string& id, const std::string& text, const Case& c) {
    const bool optional = std::any_of(c.block->ports, c.block->ports + c.block->port_count, [](const bf_port_descriptor* p) {
      return p->kind == BF_STREAM && (p->flags & BF_PORT_OPTIONAL) != 0;
    });
    if (!optional) return;
    Case open = c;
    open.feed.optional_connected = false;
    const std::string label = text + (text.empty() ? "" : ", ") + "optional inputs unconnected";
    if (!check(id, label, kSetUp, [&](const Step& step) { set_up(open, step); })) return;
    for (const BlockCheck& one : case_checks()) run(id, label, one, open);
  }

  Report& report_;
  const Options& options_;
};

}  // namespace

Report check_plugin(const std::string& file, const Options& options) {
  Report report;
  report.file = file;
  Suite(report, options).run();
  return report;
}

}  // namespace bodeflow::testing
