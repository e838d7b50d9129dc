#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bodeflow {
inline namespace v0 {

/// How an effect acts. Effects of all kinds can be added to each other: pairs need no code.
enum class Acts {
  law,         ///< at a place: a reaction over flow and stored quantity; the plant is simulated
  immittance,  ///< at a place: an impedance, effort lost = Z(s) flow; the plant stays linear
  input,       ///< on the samples of the input, before the plant
  output,      ///< on the samples of the output, behind it
  series,      ///< multiplies the response from the input to the output
  parallel,    ///< adds a response from the first input to the output
  delay,       ///< the output comes later
  tone         ///< sinusoids of the output that the input does not make; amplitude and phase are fitted in every record
};

/// What is static about an effect, said in `static void describe(DescribeEffect&)`.
struct EffectDescription {
  std::string id;       ///< "family.name"; candidates go by `name`
  std::string summary;  ///< one sentence, for somebody who is no specialist
  std::string doc;      ///< law, assumptions, when it is wrong
  std::string references;
  Acts acts = Acts::law;
  std::vector<std::string> kinds;  ///< of places, for law and immittance
  std::size_t memory = 0;          ///< numbers that a law or a map keeps from step to step
  int steps_per_sample = 1;        ///< of the simulation, at least: more where a law changes within a sample
  bool rough = false;              ///< the law jumps or has corners
  bool nonstationary = false;      ///< depends on the time since the record began: skirts beside the lines
  bool memoryless_linear = false;  ///< the map of an input or output is a constant that is added: an offset
  /// Names of effects that no experiment of this kind tells apart from this one, and what would.
  std::vector<std::string> equivalents;
  std::string separation;

  std::string name() const { return id.substr(id.find('.') + 1); }
  /// The model with it is still linear and known in closed form.
  bool linear() const { return acts != Acts::law && acts != Acts::input && acts != Acts::output; }
};

/// The argument of an effect's `describe`.
class DescribeEffect {
 public:
  explicit DescribeEffect(EffectDescription& d) : d_(d) {}

  DescribeEffect& id(std::string_view text) { return d_.id = text, *this; }
  DescribeEffect& summary(std::string_view text) { return d_.summary = text, *this; }
  DescribeEffect& doc(std::string_view text) { return d_.doc = text, *this; }
  DescribeEffect& reference(std::string_view text) {
    if (!d_.references.empty()) d_.references += '\n';
    d_.references += text;
    return *this;
  }
  DescribeEffect& acts(Acts acts) { return d_.acts = acts, *this; }
  /// A law or an immittance at places of these kinds.
  DescribeEffect& acts(Acts acts, std::vector<std::string> kinds) {
    d_.acts = acts;
    d_.kinds = std::move(kinds);
    return *this;
  }
  DescribeEffect& memory(std::size_t numbers) { return d_.memory = numbers, *this; }
  DescribeEffect& steps_per_sample(int steps) { return d_.steps_per_sample = steps, *this; }
  DescribeEffect& rough() { return d_.rough = true, *this; }
  DescribeEffect& nonstationary() { return d_.nonstationary = true, *this; }
  /// A map that adds a constant, and nothing else.
  DescribeEffect& constant() { return d_.memoryless_linear = true, *this; }
  DescribeEffect& equivalent_to(std::vector<std::string> names, std::string_view separation) {
    d_.equivalents = std::move(names);
    d_.separation = separation;
    return *this;
  }

 private:
  EffectDescription& d_;
};

}  // namespace v0
}  // namespace bodeflow
