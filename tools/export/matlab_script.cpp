#include "export/matlab_script.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>

namespace bodeflow::tools::exports {
namespace {

/// Numbers of rows, between `row_end`s.
std::string numbers(const Eigen::MatrixXd& m, const char* between, const char* row_start, const char* row_end) {
  std::string text;
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    text += row_start;
    for (Eigen::Index j = 0; j < m.cols(); ++j) text += (j == 0 ? "" : between) + fmt::format("{:.17g}", m(i, j));
    text += row_end;
  }
  return text;
}

std::string matlab_matrix(const std::string& name, const Eigen::MatrixXd& m) {
  if (m.size() == 0) return fmt::format("{} = zeros({}, {});\n", name, m.rows(), m.cols());
  return name + " = [\n" + numbers(m, " ", "  ", ";\n") + "];\n";
}

std::string quoted(const std::string& text, char quote, bool doubled) {
  std::string out(1, quote);
  for (const char c : text) {
    if (c == quote || (!doubled && c == '\\')) out += doubled ? c : '\\';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out + quote;
}

std::string list(const std::vector<std::string>& texts, char quote, bool doubled) {
  std::string out;
  for (const std::string& text : texts) out += (out.empty() ? "" : ", ") + quoted(text, quote, doubled);
  return out;
}

/// What stands behind "name = " at the start of a line, up to `end`; nothing where there is no such line.
std::optional<std::string> assigned(const std::string& text, const std::string& name, const std::string& end) {
  const std::string head = name + " = ";
  std::size_t at = text.rfind(head, 0) == 0 ? 0 : text.find("\n" + head);
  if (at == std::string::npos) return {};
  at += text[at] == '\n' ? 1 : 0;
  const std::size_t stop = text.find(end, at);
  if (stop == std::string::npos) return {};
  return text.substr(at + head.size(), stop - at - head.size());
}

Result<Eigen::MatrixXd> matrix_in(const std::string& text, const std::string& name) {
  const auto body = assigned(text, name, ");\n").value_or("");
  long rows = 0, columns = 0;
  if (body.rfind("zeros(", 0) == 0 && std::sscanf(body.c_str(), "zeros(%ld, %ld", &rows, &columns) == 2 && rows >= 0 &&
      columns >= 0 && (rows == 0 || columns == 0))
    return Eigen::MatrixXd(rows, columns);
  const auto numbers = assigned(text, name, "];\n");
  if (!numbers || numbers->rfind("[", 0) != 0) return refused("no matrix " + name + ", as '" + name + " = [ ... ];'");
  std::vector<std::vector<double>> found(1);
  for (const char* at = numbers->c_str() + 1; *at != '\0';) {
    char* end = nullptr;
    const double value = std::strtod(at, &end);
    if (end != at) {
      found.back().push_back(value);
      at = end;
    } else if (*at == ';') {
      found.emplace_back();
      ++at;
    } else if (*at == ' ' || *at == '\n' || *at == ',' || *at == '\t' || *at == '\r') {
      ++at;
    } else {
      return refused("matrix " + name + " holds '" + std::string(1, *at) + "'");
    }
  }
  if (found.back().empty()) found.pop_back();
  if (found.empty()) return refused("matrix " + name + " has no numbers");
  Eigen::MatrixXd m(static_cast<Eigen::Index>(found.size()), static_cast<Eigen::Index>(found.front().size()));
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].size() != found.front().size()) return refused("matrix " + name + " has rows of different lengths");
    for (std::size_t j = 0; j < found[i].size(); ++j) m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = found[i][j];
  }
  return m;
}

std::vector<std::string> texts_in(const std::string& text, const std::string& name) {
  std::vector<std::string> texts;
  const auto body = assigned(text, name, "};\n").value_or("");
  for (std::size_t at = body.find('\''); at != std::string::npos; at = body.find('\'', at)) {
    std::string one;
    for (++at; at < body.size(); ++at) {
      if (body[at] != '\'') {
        one += body[at];
      } else if (at + 1 < body.size() && body[at + 1] == '\'') {
        one += body[at++];
      } else {
        break;
      }
    }
    texts.push_back(one);
    ++at;
  }
  return texts;
}

}  // namespace

std::string matlab_of(const ModelFile& file) {
  const numerics::StateSpace& s = file.system();
  std::string text = "% A linear model by bodeflow: ";
  text += s.sample_time > 0.0 ? "x[n+1] = A x[n] + B u[n], y[n] = C x[n] + D u[n]\n" : "dx/dt = A x + B u, y = C x + D u\n";
  text += matlab_matrix("A", s.A) + matlab_matrix("B", s.B) + matlab_matrix("C", s.C) + matlab_matrix("D", s.D);
  text += "Ts = [" + fmt::format("{:.17g}", s.sample_time) + "];\n";
  text += "delay = [" + fmt::format("{:.17g}", file.model.delay_s) + "];\n";
  if (file.model.denominator.size() > 0) {
    text += matlab_matrix("numerator", file.model.numerator.transpose());
    text += matlab_matrix("denominator", file.model.denominator.transpose());
  }
  text += "input_names = {" + list(file.input_names(), '\'', true) + "};\n";
  text += "output_names = {" + list(file.output_names(), '\'', true) + "};\n";
  text += "if exist('ss', 'file') || exist('ss', 'builtin')\n  sys = ss(A, B, C, D";
  text += s.sample_time > 0.0 ? ", Ts" : "";
  text += ");\n  sys.InputName = input_names;\n  sys.OutputName = output_names;\n";
  if (file.model.delay_s > 0.0)
    text += s.sample_time > 0.0 ? "  sys.OutputDelay = round(delay / Ts) * ones(size(D, 1), 1);\n"
                                : "  sys.OutputDelay = delay * ones(size(D, 1), 1);\n";
  return text + "end\n";
}

Result<ModelFile> model_in_matlab(const std::string& name, const std::string& text) {
  const auto A = matrix_in(text, "A"), B = matrix_in(text, "B"), C = matrix_in(text, "C"), D = matrix_in(text, "D"),
             Ts = matrix_in(text, "Ts"), delay = matrix_in(text, "delay");
  for (const auto* m : {&A, &B, &C, &D, &Ts, &delay})
    if (!*m) return refused(m->error());
  if (Ts->size() != 1 || delay->size() != 1) return refused("Ts and delay must be one number each");
  auto system = numerics::make_state_space(*A, *B, *C, *D, (*Ts)(0, 0));
  if (!system) return refused(system.error().text);
  Eigen::VectorXd numerator, denominator;
  if (assigned(text, "denominator", "];\n")) {
    const auto b = matrix_in(text, "numerator"), a = matrix_in(text, "denominator");
    if (!b || !a) return refused(!b ? b.error() : a.error());
    numerator = b->reshaped();
    denominator = a->reshaped();
  }
  return model_of(name, std::move(*system), (*delay)(0, 0), numerator, denominator, texts_in(text, "input_names"),
                  texts_in(text, "output_names"));
}

std::string python_of(const ModelFile& file) {
  const numerics::StateSpace& s = file.system();
  const auto array = [](const char* name, const Eigen::MatrixXd& m) {
    if (m.size() == 0) return fmt::format("{} = np.zeros(({}, {}))\n", name, m.rows(), m.cols());
    return fmt::format("{} = np.array([\n{}])\n", name, numbers(m, ", ", "    [", "],\n"));
  };
  std::string text = "\"\"\"A linear model by bodeflow: ";
  text += s.sample_time > 0.0 ? "x[n+1] = A x[n] + B u[n], y[n] = C x[n] + D u[n]" : "dx/dt = A x + B u, y = C x + D u";
  text += ".\"\"\"\n\nimport numpy as np\n\n";
  text += array("A", s.A) + array("B", s.B) + array("C", s.C) + array("D", s.D);
  text += fmt::format("dt = {:.17g}  # sample time in s; 0: continuous in time\n", s.sample_time);
  text += fmt::format("delay = {:.17g}  # of the outputs in s, beside the matrices\n", file.model.delay_s);
  text += "input_names = [" + list(file.input_names(), '"', false) + "]\n";
  text += "output_names = [" + list(file.output_names(), '"', false) + "]\n\n\n";
  text +=
      "def scipy_system():\n    from scipy import signal\n\n"
      "    return signal.StateSpace(A, B, C, D) if dt == 0 else signal.StateSpace(A, B, C, D, dt=dt)\n\n\n"
      "def control_system():\n    import control\n\n"
      "    return control.ss(A, B, C, D, dt, inputs=input_names, outputs=output_names)\n\n\n"
      "def frequency_response(frequency_hz):\n"
      "    \"\"\"G at each frequency [Hz]: lines x outputs x inputs, with the delay.\"\"\"\n"
      "    s = 2j * np.pi * np.atleast_1d(np.asarray(frequency_hz, dtype=float))\n"
      "    x = s if dt == 0 else np.exp(s * dt)\n"
      "    G = np.array([C @ np.linalg.solve(v * np.eye(len(A)) - A, B) + D for v in x])\n"
      "    return G * np.exp(-s * delay)[:, None, None]\n";
  return text;
}

}  // namespace bodeflow::tools::exports
