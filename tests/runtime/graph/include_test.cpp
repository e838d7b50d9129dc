#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "catch.hpp"
#include "registry.hpp"

namespace bodeflow::graph {
namespace {

namespace fs = std::filesystem;

/// A folder of graph files that goes when the test ends.
class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "bodeflow_graph_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
  }

  tl::expected<Graph, Problems> load(const std::string& name) const {
    return graph::load((path_ / name).string(), {}, test_registry());
  }

  /// The problems with the folder's own name taken out.
  std::string problems(const std::string& name) const {
    const auto graph = load(name);
    if (graph) return "no problems";
    std::string text = to_string(graph.error());
    const std::string prefix = path_.string() + "/";
    for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) text.erase(at, prefix.size());
    return text;
  }

  fs::path path() const { return path_; }

 private:
  fs::path path_;
};

const std::string kMain =
    "bodeflow: 1\ninclude: [parts/source.yaml]\nvariables: {k: 3}\nblocks: {g: {block: filters.gain, gain: "
    "\"${k}\"}}\nconnections: [s -> g]\n";

}  // namespace

TEST_CASE("include: blocks, variables and connections of the files belong to one graph") {
  const Folder folder;
  folder.write("main.yaml", kMain);
  folder.write("parts/source.yaml",
               "include: [deep/plant.yaml]\nvariables: {f: 5 Hz}\nblocks: {s: {block: generators.sine, frequency: \"${f}\"}}\n"
               "connections: [s -> p]\nschedule: [{at: 1 s, block: g, set: {gain: 4}}]\nrequires: {plants: '>=1'}\n");
  folder.write("parts/deep/plant.yaml",
               "bodeflow: 1\nblocks: {p: {block: plants.linear}, d: {block: acquisition.file, file: ../x.csv}}\n");
  const auto graph = folder.load("main.yaml");
  REQUIRE(graph);
  const Phase& phase = graph->phases.at(0);
  REQUIRE(phase.blocks.size() == 4);
  CHECK(phase.blocks[0].name == "p");
  CHECK(phase.blocks[2].name == "s");
  CHECK(phase.blocks[3].name == "g");
  CHECK(phase.blocks[1].parameters[0].strings[0] == (folder.path() / "parts/x.csv").string());
  CHECK(phase.blocks[2].parameters[0].numbers[0] == 5.0);
  CHECK(phase.streams.size() == 2);
  CHECK(phase.schedule.size() == 1);
  CHECK(phase.blocks[2].place.file == (folder.path() / "parts/source.yaml").string());
  CHECK(phase.blocks[2].place.line == 3);
  CHECK(graph->expanded.find("include") == std::string::npos);
  CHECK(good(graph->expanded).expanded == graph->expanded);
}

TEST_CASE("include: a problem carries the name of the file in which it stands") {
  const Folder folder;
  folder.write("main.yaml", kMain);
  folder.write("parts/source.yaml",
               "blocks:\n  s: {block: generators.sine, frequenzy: 3}\n  z: {block: generators.sin}\nrun: {}\n");
  CHECK(folder.problems("main.yaml") ==
        "parts/source.yaml:2:31: block 's': unknown parameter 'frequenzy' (did you mean 'frequency'?)\n"
        "parts/source.yaml:3:14: block 'z': unknown block 'generators.sin' (did you mean 'generators.sine'?)\n"
        "parts/source.yaml:4:1: key 'run' can't stand in an included file; allowed: bodeflow, include, requires, variables, "
        "blocks, "
        "connections, schedule, limits");
}

TEST_CASE("include: what stands in two files is an error with both places") {
  const Folder folder;
  folder.write("main.yaml", kMain);
  folder.write("parts/source.yaml", "variables: {k: 4}\nblocks: {s: {block: generators.sine}, g: {block: filters.gain}}\n");
  CHECK(folder.problems("main.yaml") ==
        "main.yaml:3:13: variables: 'k' is there twice (first at parts/source.yaml:1:13)\n"
        "main.yaml:4:10: blocks: 'g' is there twice (first at parts/source.yaml:2:39)");
}

TEST_CASE("include: files that include each other are named in their cycle") {
  const Folder folder;
  folder.write("main.yaml", "bodeflow: 1\ninclude: [a.yaml]\nblocks: {}\n");
  folder.write("a.yaml", "include: [sub/b.yaml]\n");
  folder.write("sub/b.yaml", "include: [../a.yaml]\n");
  CHECK(folder.problems("main.yaml") == "sub/b.yaml:1:11: files include each other: a.yaml -> sub/b.yaml -> a.yaml");
}

TEST_CASE("include: the same file twice is an error with both places") {
  const Folder folder;
  folder.write("main.yaml", "bodeflow: 1\ninclude: [a.yaml, ./a.yaml]\nblocks: {}\n");
  folder.write("a.yaml", "blocks: {}\n");
  CHECK(folder.problems("main.yaml") == "main.yaml:2:19: 'a.yaml' is included twice (first at main.yaml:2:11)");
}

TEST_CASE("include: a broken file and an absent one are both reported") {
  const Folder folder;
  folder.write("main.yaml", "bodeflow: 1\ninclude: [a.yaml, b.yaml]\nblocks: {}\n");
  folder.write("a.yaml", "blocks: {a: [}\n");
  CHECK(folder.problems("main.yaml") ==
        "main.yaml:2:19: can't read 'b.yaml': there is no such file\na.yaml:1:14: not valid YAML: ']' or '}' without its "
        "beginning");
}

TEST_CASE("load: a file that is not there, or no file, is refused by name") {
  const auto refused = [](const std::string& file) { return to_string(load(file, {}, test_registry()).error()); };
  CHECK(refused("/no/such/graph.yaml") == "can't read '/no/such/graph.yaml': there is no such file");
  CHECK(refused("/tmp") == "can't read '/tmp': it is a folder");
  CHECK(refused("/dev/zero") == "can't read '/dev/zero': it is not a regular file");
}

}  // namespace bodeflow::graph
