#pragma once

#include <bodeflow/parameter_types.hpp>
#include <bodeflow/ports.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace bodeflow {
inline namespace v0 {

/// One port as described; owned texts.
struct PortDraft {
  std::uint32_t kind = BF_STREAM;
  std::uint32_t direction = BF_IN;
  std::uint32_t element = BF_ANY;
  int index = 0;
  bool optional = false;
  int same_as = -1;  ///< stream outputs: the stream input whose facts they take
  std::string name, record_type, doc;
};

/// One parameter as described; owned texts.
struct ParameterDraft {
  std::uint32_t type = 0;
  bool required = false, live = false, exclusive_minimum = false, exclusive_maximum = false;
  std::string name, unit, doc, aliases;
  std::vector<std::string> choices;
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  StoredValue fallback;
};

/// All that `describe` said of a block, before it is checked (block_type.hpp).
struct BlockDraft {
  std::uint32_t flags = 0;
  double cost_ns = 0.0;
  std::string id, summary, doc, references, roles;
  std::vector<PortDraft> ports;
  std::vector<ParameterDraft> parameters;
};

/// Says more about the port described last.
class PortEntry {
 public:
  explicit PortEntry(PortDraft& port) : port_(port) {}
  /// An input that may stay unconnected.
  PortEntry& optional() { return port_.optional = true, *this; }
  PortEntry& doc(std::string_view text) { return port_.doc = text, *this; }
  /// Of a stream output: it has the facts of that stream input, unless `resolve` says otherwise.
  template <class T>
  PortEntry& same_as(In<T> port) {
    return port_.same_as = port.index, *this;
  }
  /// Of a message port: the type of the records that it carries; any without.
  PortEntry& record_type(std::string_view type) { return port_.record_type = type, *this; }

 private:
  PortDraft& port_;
};

/// Says more about the parameter described last.
class ParameterEntry {
 public:
  explicit ParameterEntry(ParameterDraft& parameter) : p_(parameter) {}
  /// Unit of the numbers: "Hz", "s", "V" ...; "1" without dimension, "" any.
  ParameterEntry& unit(std::string_view text) { return p_.unit = text, *this; }
  /// Allowed values, both limits included.
  ParameterEntry& range(double minimum, double maximum) {
    p_.minimum = minimum;
    p_.maximum = maximum;
    p_.exclusive_minimum = p_.exclusive_maximum = false;
    return *this;
  }
  /// Values above `minimum`, which itself is not allowed.
  ParameterEntry& above(double minimum) {
    p_.minimum = minimum;
    p_.exclusive_minimum = true;
    return *this;
  }
  /// Values below `maximum`, which itself is not allowed.
  ParameterEntry& below(double maximum) {
    p_.maximum = maximum;
    p_.exclusive_maximum = true;
    return *this;
  }
  /// Of a text: the words that are allowed.
  ParameterEntry& choices(std::vector<std::string> words) {
    p_.choices = std::move(words);
    p_.type = p_.type == BF_STRING ? static_cast<std::uint32_t>(BF_CHOICE) : p_.type;
    p_.fallback.type = p_.type;
    return *this;
  }
  /// May change while the block runs: `change` is called.
  ParameterEntry& live() { return p_.live = true, *this; }
  /// An earlier name that graphs may still use.
  ParameterEntry& alias(std::string_view name) {
    if (!p_.aliases.empty()) p_.aliases += ' ';
    p_.aliases += name;
    return *this;
  }
  ParameterEntry& doc(std::string_view text) { return p_.doc = text, *this; }

 private:
  ParameterDraft& p_;
};

/// Collects what a block is: the argument of `static void describe(Describe&)`.
class Describe {
 public:
  explicit Describe(BlockDraft& draft) : draft_(draft) {}

  /// "family.name", the name under which graphs use the block.
  Describe& id(std::string_view text) { return draft_.id = text, *this; }
  /// One sentence.
  Describe& summary(std::string_view text) { return draft_.summary = text, *this; }
  /// The rest: equations, assumptions, when the block is biased or wrong.
  Describe& doc(std::string_view text) { return draft_.doc = text, *this; }
  /// Author, title, year, DOI. Each call adds a line.
  Describe& reference(std::string_view text) { return add(draft_.references, '\n', text), *this; }
  /// A word that says what the block is good for: "source", "identifier". Each call adds one.
  Describe& role(std::string_view word) { return add(draft_.roles, ' ', word), *this; }
  /// `process` neither allocates, locks nor does input or output.
  Describe& realtime_safe() { return draft_.flags |= BF_BLOCK_REALTIME_SAFE, *this; }
  /// Output k may share memory with input k of equal element and channels.
  Describe& in_place() { return draft_.flags |= BF_BLOCK_IN_PLACE, *this; }
  /// A block of message ports alone that may compute on another thread during its latency.
  Describe& asynchronous() { return draft_.flags |= BF_BLOCK_ASYNCHRONOUS, *this; }
  /// Typical cost of one firing in nanoseconds: threads are shared out by it.
  Describe& cost_ns(double nanoseconds) { return draft_.cost_ns = nanoseconds, *this; }

  template <class T>
  PortEntry stream_in(In<T> port) {
    return port_entry(BF_STREAM, BF_IN, port.index, port.name, kElementOf<T>);
  }
  template <class T>
  PortEntry stream_out(Out<T> port) {
    return port_entry(BF_STREAM, BF_OUT, port.index, port.name, kElementOf<T>);
  }
  PortEntry message_in(MessageIn port) { return port_entry(BF_MESSAGE, BF_IN, port.index, port.name, BF_ANY); }
  PortEntry message_out(MessageOut port) { return port_entry(BF_MESSAGE, BF_OUT, port.index, port.name, BF_ANY); }

  /// A parameter with a default, whose C++ type is the parameter's type.
  template <class T>
  ParameterEntry parameter(std::string_view name, const T& fallback) {
    ParameterDraft& p = add_parameter<std::decay_t<const T>>(name);
    if constexpr (std::is_array_v<T>) {
      p.fallback = stored_value(std::string(fallback));
    } else {
      p.fallback = stored_value(fallback);
    }
    return ParameterEntry(p);
  }
  /// A parameter that every graph must give.
  template <class T>
  ParameterEntry required(std::string_view name) {
    ParameterDraft& p = add_parameter<T>(name);
    p.required = true;
    return ParameterEntry(p);
  }
  /// A parameter that may be absent: `Parameters::has` tells.
  template <class T>
  ParameterEntry optional(std::string_view name) {
    return ParameterEntry(add_parameter<T>(name));
  }

 private:
  static void add(std::string& to, char separator, std::string_view text) {
    if (!to.empty()) to += separator;
    to += text;
  }

  PortEntry port_entry(std::uint32_t kind, std::uint32_t direction, int index, const char* name, std::uint32_t element) {
    PortDraft port;
    port.kind = kind;
    port.direction = direction;
    port.element = element;
    port.index = index;
    port.name = name == nullptr ? "" : name;
    draft_.ports.push_back(std::move(port));
    return PortEntry(draft_.ports.back());
  }

  template <class T>
  ParameterDraft& add_parameter(std::string_view name) {
    static_assert(parameter_type<T>() != 0,
                  "parameters are bool, integer, double, text, File, Matrix, or std::vector of double, std::int64_t, "
                  "std::string, std::complex<double>");
    ParameterDraft p;
    p.name = name;
    p.type = parameter_type<T>();
    p.fallback.type = p.type;
    draft_.parameters.push_back(std::move(p));
    return draft_.parameters.back();
  }

  BlockDraft& draft_;
};

}  // namespace v0
}  // namespace bodeflow
