#include "export/mat_file.hpp"

#include <zlib.h>

#include <cstring>
#include <limits>
#include <map>
#include <optional>

// Layout: "MAT-File Format", The MathWorks, level 5. Numbers are written in this machine's order, little-endian, which the header
// states.
namespace bodeflow::tools::exports {
namespace {

constexpr std::uint32_t kInt8 = 1, kUInt8 = 2, kInt16 = 3, kUInt16 = 4, kInt32 = 5, kUInt32 = 6, kSingle = 7, kDouble = 9,
                        kMatrix = 14, kCompressed = 15, kUtf8 = 16;
constexpr std::uint32_t kCellClass = 1, kCharClass = 4, kDoubleClass = 6, kLastNumericClass = 13, kComplexFlag = 0x0800;
constexpr std::size_t kHeader = 128;
constexpr std::size_t kMostInflated = std::size_t{1} << 30;

// ---- writing

void put_u32(std::string& out, std::uint32_t value) { out.append(reinterpret_cast<const char*>(&value), 4); }

std::string element(std::uint32_t type, const std::string& data) {
  std::string out;
  put_u32(out, type);
  put_u32(out, static_cast<std::uint32_t>(data.size()));
  out += data;
  out.append((8 - data.size() % 8) % 8, '\0');
  return out;
}

std::string array(std::uint32_t kind, std::size_t rows, std::size_t columns, const std::string& name,
                  const std::string& content) {
  std::string flags, dimensions;
  put_u32(flags, kind);
  put_u32(flags, 0);
  put_u32(dimensions, static_cast<std::uint32_t>(rows));
  put_u32(dimensions, static_cast<std::uint32_t>(columns));
  return element(kMatrix, element(kUInt32, flags) + element(kInt32, dimensions) + element(kInt8, name) + content);
}

std::string matrix(const std::string& name, const Eigen::MatrixXd& m) {
  const std::string data(reinterpret_cast<const char*>(m.data()), static_cast<std::size_t>(m.size()) * sizeof(double));
  return array(kDoubleClass, static_cast<std::size_t>(m.rows()), static_cast<std::size_t>(m.cols()), name,
               element(kDouble, data));
}

std::string number(const std::string& name, double value) { return matrix(name, Eigen::MatrixXd::Constant(1, 1, value)); }

std::string cells(const std::string& name, const std::vector<std::string>& texts) {
  std::string content;
  for (const std::string& text : texts) content += array(kCharClass, 1, text.size(), "", element(kUtf8, text));
  return array(kCellClass, 1, texts.size(), name, content);
}

// ---- reading

/// A stretch of bytes that is consumed element by element.
struct Bytes {
  const char* at;
  std::size_t left;
};

struct Element {
  std::uint32_t type;
  Bytes data;
};

std::uint32_t u32_at(const char* at) {
  std::uint32_t value;
  std::memcpy(&value, at, 4);
  return value;
}

std::optional<Element> next(Bytes& bytes) {
  if (bytes.left < 8) return {};
  const std::uint32_t head = u32_at(bytes.at);
  if (head >> 16 != 0) {  // a short element: size and type in one word, four bytes of data
    const std::uint32_t size = head >> 16;
    if (size > 4) return {};
    Element e{head & 0xffff, {bytes.at + 4, size}};
    bytes = {bytes.at + 8, bytes.left - 8};
    return e;
  }
  const std::size_t size = u32_at(bytes.at + 4);
  if (size > bytes.left - 8) return {};
  Element e{head, {bytes.at + 8, size}};
  const std::size_t padded = head == kCompressed ? size : size + (8 - size % 8) % 8, step = std::min(padded + 8, bytes.left);
  bytes = {bytes.at + step, bytes.left - step};
  return e;
}

template <class T>
void widen(const Bytes& data, Eigen::VectorXd& values) {
  values.resize(static_cast<Eigen::Index>(data.left / sizeof(T)));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    T value;
    std::memcpy(&value, data.at + static_cast<std::size_t>(i) * sizeof(T), sizeof(T));
    values[i] = static_cast<double>(value);
  }
}

/// Numbers of any type that MATLAB may have packed them into.
std::optional<Eigen::VectorXd> numbers_of(const Element& e) {
  Eigen::VectorXd values;
  switch (e.type) {
    case kInt8:
      widen<std::int8_t>(e.data, values);
      return values;
    case kUInt8:
    case kUtf8:
      widen<std::uint8_t>(e.data, values);
      return values;
    case kInt16:
      widen<std::int16_t>(e.data, values);
      return values;
    case kUInt16:
      widen<std::uint16_t>(e.data, values);
      return values;
    case kInt32:
      widen<std::int32_t>(e.data, values);
      return values;
    case kUInt32:
      widen<std::uint32_t>(e.data, values);
      return values;
    case kSingle:
      widen<float>(e.data, values);
      return values;
    case kDouble:
      widen<double>(e.data, values);
      return values;
    default:
      return {};
  }
}

struct Variables {
  std::map<std::string, Eigen::MatrixXd> matrices;
  std::map<std::string, std::vector<std::string>> texts;
};

struct Array {
  std::string name;
  std::uint32_t kind = 0;
  bool complex = false;
  std::size_t rows = 0, columns = 0;
  Bytes content{nullptr, 0};
};

std::optional<Array> array_in(Bytes bytes) {
  Array a;
  const auto flags = next(bytes), dimensions = next(bytes), name = next(bytes);
  if (!flags || !dimensions || !name || flags->data.left < 8 || dimensions->data.left != 8) return {};
  a.kind = u32_at(flags->data.at) & 0xff;
  a.complex = (u32_at(flags->data.at) & kComplexFlag) != 0;
  a.rows = u32_at(dimensions->data.at);
  a.columns = u32_at(dimensions->data.at + 4);
  a.name.assign(name->data.at, name->data.left);
  a.content = bytes;
  return a;
}

std::string text_of(Bytes content) {
  const auto data = next(content);
  const auto codes = data ? numbers_of(*data) : std::nullopt;
  std::string text;
  for (Eigen::Index i = 0; codes && i < codes->size(); ++i) {
    const double c = (*codes)[i];
    text += data->type == kUtf8 || data->type == kUInt8 || (c > 0 && c < 128) ? static_cast<char>(c) : '?';
  }
  return text;
}

void keep(const Array& a, Variables& variables) {
  if (a.kind == kCellClass) {
    std::vector<std::string> texts;
    Bytes rest = a.content;
    while (const auto cell = next(rest)) {
      const auto inner = array_in(cell->data);
      texts.push_back(inner && inner->kind == kCharClass ? text_of(inner->content) : "");
    }
    variables.texts[a.name] = texts;
    return;
  }
  if (a.kind < kDoubleClass || a.kind > kLastNumericClass || a.complex) return;
  Bytes content = a.content;
  const auto data = next(content);
  const auto numbers = data ? numbers_of(*data) : std::optional(Eigen::VectorXd());
  if (!numbers || static_cast<std::size_t>(numbers->size()) != a.rows * a.columns) return;
  variables.matrices[a.name] = numbers->reshaped(static_cast<Eigen::Index>(a.rows), static_cast<Eigen::Index>(a.columns));
}

std::optional<std::string> inflated(const Bytes& data) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return {};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.at));
  stream.avail_in = static_cast<uInt>(data.left);
  std::string out, chunk(1 << 16, '\0');
  int status = Z_OK;
  while (status == Z_OK && out.size() < kMostInflated) {
    stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
    stream.avail_out = static_cast<uInt>(chunk.size());
    status = inflate(&stream, Z_NO_FLUSH);
    out.append(chunk, 0, chunk.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END) return {};
  return out;
}

Result<Variables> variables_in(const std::string& bytes) {
  if (bytes.size() < kHeader || bytes.compare(126, 2, "IM") != 0)
    return refused("no MATLAB file of version 5 (save -v6 or -v7 writes one)");
  Variables variables;
  Bytes rest{bytes.data() + kHeader, bytes.size() - kHeader};
  while (rest.left > 0) {
    auto e = next(rest);
    if (!e) return refused("the file is cut off or damaged");
    std::optional<std::string> unpacked;
    if (e->type == kCompressed) {
      unpacked = inflated(e->data);
      if (!unpacked) return refused("the file is cut off or damaged");
      Bytes inner{unpacked->data(), unpacked->size()};
      e = next(inner);
    }
    if (!e || e->type != kMatrix) continue;
    if (const auto a = array_in(e->data)) keep(*a, variables);
  }
  return variables;
}

double one_number(const Variables& v, const char* name) {
  const auto found = v.matrices.find(name);
  return found != v.matrices.end() && found->second.size() == 1 ? found->second(0, 0) : 0.0;
}

}  // namespace

std::string mat_of(const ModelFile& file) {
  const numerics::StateSpace& s = file.system();
  std::string out = "MATLAB 5.0 MAT-file, a linear model by bodeflow";
  out.resize(kHeader - 4, ' ');
  out.append("\x00\x01IM", 4);
  out += matrix("A", s.A) + matrix("B", s.B) + matrix("C", s.C) + matrix("D", s.D);
  out += number("Ts", s.sample_time) + number("delay", file.model.delay_s);
  if (file.model.denominator.size() > 0)
    out += matrix("numerator", file.model.numerator.transpose()) + matrix("denominator", file.model.denominator.transpose());
  return out + cells("input_names", file.input_names()) + cells("output_names", file.output_names());
}

Result<ModelFile> model_in_mat(const std::string& name, const std::string& bytes) {
  const auto v = variables_in(bytes);
  if (!v) return refused(v.error());
  for (const char* needed : {"A", "B", "C", "D"}) {
    if (v->matrices.count(needed) == 0) return refused("no real matrix '" + std::string(needed) + "' in it");
  }
  auto system = numerics::make_state_space(v->matrices.at("A"), v->matrices.at("B"), v->matrices.at("C"), v->matrices.at("D"),
                                           one_number(*v, "Ts"));
  if (!system) return refused(system.error().text);
  Eigen::VectorXd numerator, denominator;
  if (v->matrices.count("numerator") != 0 && v->matrices.count("denominator") != 0) {
    numerator = v->matrices.at("numerator").reshaped();
    denominator = v->matrices.at("denominator").reshaped();
  }
  const auto texts = [&](const char* key) {
    const auto found = v->texts.find(key);
    return found == v->texts.end() ? std::vector<std::string>() : found->second;
  };
  return model_of(name, std::move(*system), one_number(*v, "delay"), numerator, denominator, texts("input_names"),
                  texts("output_names"));
}

}  // namespace bodeflow::tools::exports
