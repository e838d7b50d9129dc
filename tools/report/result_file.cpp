#include "report/result_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

using nlohmann::ordered_json;

/// Takes the events of the JSON parser. A place in the file is the list of keys that lead to it; a list is the key "[]".
class Reader final : public nlohmann::json_sax<ordered_json> {
 public:
  explicit Reader(ResultFile& file) : file_(file) {}

  bool null() override { return value(nullptr, kNaN); }
  bool boolean(bool x) override { return value(x, kNaN); }
  bool number_integer(number_integer_t x) override { return value(x, static_cast<double>(x)); }
  bool number_unsigned(number_unsigned_t x) override { return value(x, static_cast<double>(x)); }
  bool number_float(number_float_t x, const string_t&) override { return value(x, x); }
  bool string(string_t& x) override { return value(x, kNaN); }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return enter(false); }
  bool start_array(std::size_t) override { return enter(true); }

  bool key(string_t& name) override {
    path_.back().key = name;
    return true;
  }
  bool end_object() override { return leave(); }
  bool end_array() override { return leave(); }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception&) override {
    file_.problems.push_back(fmt::format("result.json is cut off or damaged at byte {}: what stands before is shown", position));
    return false;
  }

 private:
  struct Level {
    bool list = false;
    std::string key;
  };

  static constexpr std::size_t kDeepest = 64;

  const std::string& key_at(std::size_t depth) const { return path_[depth].key; }
  bool in_results() const { return path_.size() >= 2 && !path_[0].list && key_at(0) == "results"; }
  bool in_record() const { return in_results() && path_.size() >= 3; }
  bool in_array() const { return in_record() && path_.size() >= 5 && key_at(2) == "arrays" && !path_[3].list; }

  bool enter(bool list) {
    if (path_.size() >= kDeepest) {
      file_.problems.push_back(fmt::format("result.json is nested deeper than {} levels: what stands before is shown", kDeepest));
      return false;
    }
    path_.push_back({list, list ? "[]" : ""});
    if (path_.size() == 3 && in_results()) {
      record_ = Record{};
      record_.key = key_at(1);
    }
    if (path_.size() == 5 && in_array() && !list) array_ = Array{};
    if (path_.size() == 7 && in_array() && list) parts_ = 0;
    if (path_.size() == 5 && in_record() && list && key_at(2) == "attributes")
      record_.attributes[key_at(3)] = ordered_json::array();
    return true;
  }

  bool leave() {
    if (path_.size() == 5 && in_array()) add_array();
    if (path_.size() == 7 && in_array() && parts_ != 2) complex_parts_ = false;
    if (path_.size() == 3 && in_results()) add_record();
    path_.pop_back();
    return true;
  }

  void add_array() {
    const std::uint64_t count = count_of(array_.shape);
    const bool mixed = !array_.im.empty() && array_.im.size() != array_.re.size();
    if (mixed || !complex_parts_ || !plain_ || count != array_.re.size())
      file_.problems.push_back(fmt::format("'{}': array '{}' is left out: its {} values don't fit its shape", record_.key,
                                           key_at(3), array_.re.size()));
    else
      record_.arrays.emplace_back(key_at(3), std::move(array_));
    array_ = Array{};
    complex_parts_ = plain_ = true;
  }

  void add_record() {
    if (record_.type.empty())
      file_.problems.push_back(fmt::format("'{}' is left out: it has no type, so it is no record", record_.key));
    else
      file_.records.push_back(std::move(record_));
    record_ = Record{};
  }

  bool value(const ordered_json& json, double number) {
    if (path_.size() == 1 && !path_[0].list && json.is_string()) {
      if (key_at(0) == "graph") file_.graph = json;
      if (key_at(0) == "status") file_.status = json;
    }
    if (!in_record()) return true;
    if (path_.size() == 3 && key_at(2) == "type" && json.is_string()) record_.type = json;
    if (key_at(2) == "attributes" && path_.size() == 4) record_.attributes[key_at(3)] = json;
    if (key_at(2) == "attributes" && path_.size() == 5 && path_[4].list) record_.attributes[key_at(3)].push_back(json);
    if (in_array()) array_value(json, number);
    return true;
  }

  void array_value(const ordered_json& json, double number) {
    const std::string& field = key_at(4);
    if (path_.size() == 5 && field == "unit" && json.is_string()) array_.unit = json;
    if (path_.size() == 6 && path_[5].list && field == "shape") {
      plain_ &= json.is_number_unsigned();
      array_.shape.push_back(json.is_number_unsigned() ? json.get<std::uint64_t>() : 0);
    }
    if (field != "data" || path_.size() < 6) return;
    plain_ &= json.is_number() || json.is_null();
    if (path_.size() == 6) {
      array_.re.push_back(number);
    } else if (path_.size() == 7) {
      (parts_ == 0 ? array_.re : array_.im).push_back(number);
      ++parts_;
    }
  }

  ResultFile& file_;
  std::vector<Level> path_;
  Record record_;
  Array array_;
  int parts_ = 0;              ///< numbers of the complex value that is being read
  bool complex_parts_ = true;  ///< every complex value so far had two
  bool plain_ = true;          ///< the data so far were numbers or null
};

}  // namespace

tl::expected<ResultFile, std::string> read_result(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!stream) return tl::unexpected(fmt::format("can't read '{}': {}", path.string(), std::strerror(errno)));
  ResultFile file;
  Reader reader(file);
  ordered_json::sax_parse(stream.get(), &reader);
  return file;
}

}  // namespace bodeflow::tools::report
