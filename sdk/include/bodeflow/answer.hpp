#pragma once

#include <bodeflow/part_values.hpp>
#include <exception>
#include <string>
#include <vector>

namespace bodeflow::detail {

/// Receives what a part gives in one call.
class Answer {
 public:
  Answer() : c_{sizeof(bf_answer), 0, this, error, text, numbers, parameter, place, input} {}
  Answer(const Answer&) = delete;
  Answer& operator=(const Answer&) = delete;

  const bf_answer* c() const { return &c_; }
  /// Throws Failure with the part's words where `status` is no success.
  void check(std::int32_t status) const {
    if (out_of_memory_) fail("no memory for the answer of a part");
    if (status != BF_OK) fail(error_.empty() ? "failed without a reason" : error_);
  }

  std::vector<std::string> texts;
  std::vector<std::vector<double>> values;
  std::vector<FitParameter> parameters;
  std::vector<Place> places;
  std::vector<PlantInput> inputs;

 private:
  /// Nothing of ours is thrown through the part.
  template <class Work>
  static void take(void* context, Work&& work) noexcept {
    Answer& self = *static_cast<Answer*>(context);
    try {
      work(self);
    } catch (...) {
      self.out_of_memory_ = true;
    }
  }
  static void error(void* context, const char* c) noexcept {
    take(context, [&](Answer& a) { a.error_ = detail::text(c); });
  }
  static void text(void* context, const char* c) noexcept {
    take(context, [&](Answer& a) { a.texts.push_back(detail::text(c)); });
  }
  static void numbers(void* context, const double* values, std::uint64_t count) noexcept {
    take(context, [&](Answer& a) { a.values.push_back(owned(bf_numbers{values, count})); });
  }
  static void parameter(void* context, const bf_fit_parameter* c) noexcept {
    take(context, [&](Answer& a) { a.parameters.push_back(owned(*c)); });
  }
  static void place(void* context, const bf_place* c) noexcept {
    take(context, [&](Answer& a) { a.places.push_back(owned(*c)); });
  }
  static void input(void* context, std::int32_t channel, std::int32_t derivative) noexcept {
    take(context, [&](Answer& a) { a.inputs.push_back({channel, derivative}); });
  }

  bf_answer c_;
  std::string error_;
  bool out_of_memory_ = false;
};

/// Runs `work`; an exception of whatever type becomes BF_FAILED with its text in the answer.
template <class Work>
std::int32_t answered(const bf_answer* answer, Work&& work) noexcept {
  try {
    work();
    return BF_OK;
  } catch (const std::exception& e) {
    answer->error(answer->context, e.what());
  } catch (...) {
    answer->error(answer->context, "an exception that is not derived from std::exception");
  }
  return BF_FAILED;
}

inline void give(const bf_answer* answer, const std::string& text) { answer->text(answer->context, text.c_str()); }
inline void give(const bf_answer* answer, const std::vector<double>& values) {
  answer->values(answer->context, values.data(), values.size());
}
inline void give(const bf_answer* answer, const std::vector<FitParameter>& parameters) {
  for (const FitParameter& p : parameters) {
    const bf_fit_parameter c = borrowed(p);
    answer->parameter(answer->context, &c);
  }
}
inline void give(const bf_answer* answer, const std::vector<Place>& places) {
  for (const Place& p : places) {
    const bf_place c = borrowed(p);
    answer->place(answer->context, &c);
  }
}
inline void give(const bf_answer* answer, const std::vector<std::vector<double>>& starts) {
  for (const auto& start : starts) give(answer, start);
}

}  // namespace bodeflow::detail
