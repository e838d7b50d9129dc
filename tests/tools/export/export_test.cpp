// Files for other programs come back as the same numbers.

#include <nlohmann/json.hpp>

#include "export/mat_file.hpp"
#include "export/matlab_script.hpp"
#include "models.hpp"

using namespace bodeflow;
using namespace bodeflow::tools::exports;
using test::Folder;
using test::random_model;

namespace {

void check_same(const ModelFile& found, const ModelFile& expected) {
  CHECK(found.system().A == expected.system().A);
  CHECK(found.system().B == expected.system().B);
  CHECK(found.system().C == expected.system().C);
  CHECK(found.system().D == expected.system().D);
  CHECK(found.system().sample_time == expected.system().sample_time);
  CHECK(found.model.delay_s == expected.model.delay_s);
  CHECK(found.model.numerator == expected.model.numerator);
  CHECK(found.model.denominator == expected.model.denominator);
  CHECK(found.input_names() == expected.input_names());
  CHECK(found.output_names() == expected.output_names());
}

std::string content(const ModelFile& file, const std::string& ending) {
  return ending == ".json" ? json_of(file) : ending == ".mat" ? mat_of(file) : matlab_of(file);
}

}  // namespace

TEST_CASE("models come back from JSON, MATLAB files and scripts as the same bits") {
  const Folder folder;
  for (const double sample_time : {0.0, 1.0 / 3.0}) {
    for (const auto& [states, inputs, outputs] : {std::tuple{6, 3, 2}, {1, 1, 1}, {0, 2, 1}}) {
      ModelFile model = random_model(states, inputs, outputs, sample_time);
      if (inputs == 1) {
        const auto tf = numerics::to_transfer_function(model.system());
        REQUIRE(tf);
        auto with_polynomials = model_of("plant", model.system(), 0.1 / 3.0, tf->numerator, tf->denominator, model.input_names(),
                                         model.output_names());
        REQUIRE(with_polynomials);
        model = std::move(*with_polynomials);
      }
      for (const std::string ending : {".json", ".mat", ".m"}) {
        INFO(ending << ", " << states << " states, sample time " << sample_time);
        const auto back = read_model_file(folder.write("plant" + ending, content(model, ending)), "");
        if (!back) FAIL(back.error());
        CHECK(back->name == "plant");
        check_same(*back, model);
      }
    }
  }
}

TEST_CASE("a model with numerator and denominator alone is exported as a state space beside them") {
  records::ModelData m;
  m.form = "transfer_function";
  m.order = 2;
  m.numerator = Eigen::Vector2d(1.0, 3.0);
  m.denominator = Eigen::Vector3d(1.0, 0.2, 4.0);
  const nlohmann::ordered_json record = {
      {"type", "model"},
      {"attributes", {{"method", "x"}, {"form", "transfer_function"}, {"order", 2}, {"sample_time", 0.0}, {"delay", 0.0}}},
      {"arrays",
       {{"numerator", {{"unit", ""}, {"shape", {2}}, {"data", {1.0, 3.0}}}},
        {"denominator", {{"unit", ""}, {"shape", {3}}, {"data", {1.0, 0.2, 4.0}}}}}}};
  const Folder folder;
  const std::string file = folder.write(
      "result.json", nlohmann::ordered_json{{"bodeflow", 1}, {"status", "complete"}, {"results", {{"identify", record}}}}.dump());
  const auto model = read_model_file(file, "");
  if (!model) FAIL(model.error());
  CHECK(model->system().states() == 2);
  const auto back = read_model_file(folder.write("again.json", json_of(*model)), "");
  REQUIRE(back);
  CHECK(back->model.denominator == m.denominator);
  CHECK(back->model.method == "x");
  CHECK(back->system().A == model->system().A);
}

TEST_CASE("a Python script holds every number to the last bit") {
  const ModelFile model = random_model(3, 1, 2, 0.01);
  const std::string text = python_of(model);
  char number[32];
  for (const double x : model.system().A.reshaped()) {
    std::snprintf(number, sizeof number, "%.17g", x);
    CHECK(text.find(number) != std::string::npos);
  }
  CHECK(text.find("input_names = [\"it's u0\"]") != std::string::npos);
}

TEST_CASE("files that hold no model are refused with what is missing") {
  const Folder folder;
  const auto refusal = [&](const std::string& name, const std::string& text) {
    const std::string file = folder.write(name, text);
    const auto found = read_model_file(file, "");
    return found ? "" : found.error().substr(file.size());
  };
  CHECK(refusal("a.mat", "hello") == ": no MATLAB file of version 5 (save -v6 or -v7 writes one)");
  std::string mat = mat_of(random_model(3, 1, 1, 0.0));
  CHECK(refusal("a.mat", mat.substr(0, mat.size() - 9)) == ": the file is cut off or damaged");
  CHECK(refusal("a.mat", mat.substr(0, 128)) == ": no real matrix 'A' in it");
  CHECK(refusal("a.m", "A = [1];\nB = [1];\nC = [1];\nD = [x];\nTs = [0];\ndelay = [0];\n") == ": matrix D holds 'x'");
  CHECK(refusal("a.m", "A = [1];\nB = [1];\nC = [1];\nD = [0];\ndelay = [0];\n") == ": no matrix Ts, as 'Ts = [ ... ];'");
  CHECK(refusal("a.m", "A = [1 2];\nB = [1];\nC = [1];\nD = [0];\nTs = [0];\ndelay = [0];\n") ==
        ": A is 1 x 2, it must be square");
  CHECK(refusal("a.json", "{}") == ": is no result.json of a run: 'bodeflow' and 'results' are missing");
}

TEST_CASE("a MATLAB file of any cut or changed byte is read or refused, never more") {
  const std::string mat = mat_of(random_model(2, 1, 1, 0.0));
  for (std::size_t i = 0; i < mat.size(); ++i) {
    (void)model_in_mat("x", mat.substr(0, i));
    std::string changed = mat;
    changed[i] = static_cast<char>(changed[i] ^ 0x5a);
    const auto found = model_in_mat("x", changed);
    if (found) CHECK(found->system().states() == 2);
  }
}
