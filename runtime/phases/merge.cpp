#include <algorithm>
#include <bodeflow/record.hpp>
#include <charconv>
#include <complex>

#include "phases/sweep.hpp"

namespace bodeflow::phases {
namespace {

std::vector<RecordView> views_of(const std::vector<SharedRecord>& records) {
  std::vector<RecordView> views;
  for (const auto& record : records)
    if (auto view = RecordView::check({record.bytes(), record.size()})) views.push_back(*view);
  return views;
}

std::vector<std::uint64_t> stacked(std::size_t runs, std::span<const std::uint64_t> shape) {
  std::vector<std::uint64_t> all{runs};
  all.insert(all.end(), shape.begin(), shape.end());
  return all;
}

template <class T>
void stack(RecordBuilder& merged, const std::vector<RecordView>& views, const ArrayView& first) {
  const auto out = merged.array<T>(std::string(first.name), std::string(first.unit), stacked(views.size(), first.shape));
  std::size_t position = 0;
  for (const auto& view : views)
    for (const T& value : view.array(first.name)->template as<T>()) out[position++] = value;
}

bool in_all(const std::vector<RecordView>& views, const ArrayView& first) {
  return std::all_of(views.begin(), views.end(), [&](const RecordView& view) {
    const auto array = view.array(first.name);
    return array && array->element == first.element &&
           std::equal(array->shape.begin(), array->shape.end(), first.shape.begin(), first.shape.end());
  });
}

bool stack_array(RecordBuilder& merged, const std::vector<RecordView>& views, const ArrayView& first) {
  if (first.shape.size() >= kRecordMaxRank || !in_all(views, first)) return false;
  switch (first.element) {
    case BF_F64:
      stack<double>(merged, views, first);
      return true;
    case BF_C64:
      stack<std::complex<double>>(merged, views, first);
      return true;
    case BF_I64:
      stack<std::int64_t>(merged, views, first);
      return true;
    case BF_U8:
      stack<std::uint8_t>(merged, views, first);
      return true;
    default:
      return false;
  }
}

/// A number or truth of all runs becomes an array; a text or list of texts stays where it is the same in all.
void merge_attribute(RecordBuilder& merged, const std::vector<RecordView>& views, const std::string& name) {
  std::vector<double> numbers;
  for (const auto& view : views)
    if (const auto number = view.number(name))
      numbers.push_back(*number);
    else if (const auto truth = view.boolean(name))
      numbers.push_back(*truth ? 1.0 : 0.0);
  if (numbers.size() == views.size() && !views[0].array(name)) {
    const auto out = merged.array<double>(name, "", {numbers.size()});
    std::copy(numbers.begin(), numbers.end(), out.begin());
    return;
  }
  if (name == "of" || name == "runs") return;
  const auto same = [&](auto get) {
    return std::all_of(views.begin(), views.end(), [&](const RecordView& v) { return get(v) == get(views[0]); });
  };
  if (const auto text = views[0].text(name); text && same([&](const RecordView& v) { return v.text(name); }))
    merged.set(name, std::string(*text));
  if (const auto texts = views[0].texts(name); texts && same([&](const RecordView& v) { return v.texts(name); }))
    merged.set(name, std::vector<std::string>(texts->begin(), texts->end()));
}

}  // namespace

SharedRecord merge_records(const std::vector<SharedRecord>& records, const std::vector<graph::SweepAxis>& axes,
                           const std::vector<std::vector<std::string>>& values) {
  const std::vector<RecordView> views = views_of(records);
  RecordBuilder merged("sweep");
  if (views.size() != records.size() || views.empty()) return {};
  merged.set("of", std::string(views[0].type()));
  merged.set("runs", static_cast<std::int64_t>(views.size()));

  for (std::size_t a = 0; a < axes.size(); ++a) {
    std::vector<double> numbers;
    std::vector<std::string> texts;
    for (const auto& run : values) {
      double number = 0.0;
      const auto& text = run[a];
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
      if (error == std::errc() && end == text.data() + text.size()) numbers.push_back(number);
      texts.push_back(text);
    }
    if (numbers.size() == values.size()) {
      const auto out = merged.array<double>("axis." + axes[a].path, "", {numbers.size()});
      std::copy(numbers.begin(), numbers.end(), out.begin());
    } else {
      merged.set("axis." + axes[a].path, texts);
    }
  }
  for (const auto& attribute : views[0].attributes()) merge_attribute(merged, views, std::string(attribute.name()));
  std::vector<std::string> apart;
  for (const auto& array : views[0].arrays())
    if (!stack_array(merged, views, array)) apart.emplace_back(array.name);
  if (!apart.empty()) merged.set("not_merged", apart);  // of different shapes: they stand in the runs' own directories
  const std::vector<std::uint8_t> bytes = merged.bytes();
  return SharedRecord::copy(bytes.data(), bytes.size());
}

}  // namespace bodeflow::phases
