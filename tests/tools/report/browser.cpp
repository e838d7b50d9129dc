#include "tools/report/browser.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "system/command.hpp"

namespace bodeflow::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMeasure = R"(<script>
addEventListener('load', () => {
  const found = {page_width: document.documentElement.scrollWidth, window_width: innerWidth, bad_numbers: [], texts: 0,
    outside: [], overlapping: [], ground: getComputedStyle(document.body).backgroundColor, ink: getComputedStyle(document.body).color,
    active: document.querySelectorAll('script,img,iframe,object,embed,link,[onload],[onerror]').length - 1};
  const numeric = ['x', 'y', 'x1', 'x2', 'y1', 'y2', 'cx', 'cy', 'r', 'rx', 'width', 'height', 'd', 'viewBox', 'transform'];
  for (const svg of document.querySelectorAll('svg')) {
    for (const element of [svg, ...svg.querySelectorAll('*')])
      for (const name of numeric)
        if (element.hasAttribute(name) && /nan|inf|undefined|null/i.test(element.getAttribute(name))) found.bad_numbers.push(element.outerHTML.slice(0, 200));
    const border = svg.getBoundingClientRect();
    if (border.width === 0) continue;
    const texts = [...svg.querySelectorAll('text')].map(text => ({text: text.textContent, box: text.getBoundingClientRect()}));
    found.texts += texts.length;
    texts.forEach((a, n) => {
      const slack = 2;
      if (a.box.left < border.left - slack || a.box.right > border.right + slack || a.box.top < border.top - slack || a.box.bottom > border.bottom + slack)
        found.outside.push(svg.querySelector('title').textContent + ': ' + a.text);
      for (const b of texts.slice(n + 1)) {
        const w = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left);
        const h = Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top);
        if (w > 2 && h > 3.5) found.overlapping.push(svg.querySelector('title').textContent + ': ' + a.text + ' | ' + b.text);
      }
    });
  }
  parent.postMessage(encodeURIComponent(JSON.stringify(found)), '*');
});
</script>)";

// A window has a least width, a frame has none.
constexpr const char* kFrame = R"(<!DOCTYPE html><html><body><script>
addEventListener('message', event => document.documentElement.setAttribute('data-measured', event.data));
</script><iframe src="page.html" style="border:0;width:@px;height:1200px"></iframe></body></html>)";

std::vector<std::string> command(const fs::path& profile) {
  return {browser(),
          "--headless",
          "--no-sandbox",
          "--disable-gpu",
          "--disable-quic",
          "--no-first-run",
          "--disable-background-networking",
          "--disable-component-update",
          "--disable-sync",
          "--disable-dev-shm-usage",
          "--hide-scrollbars",
          "--user-data-dir=" + profile.string()};
}

Ended browse(const std::vector<std::string>& options, const fs::path& page) {
  const Folder profile;
  std::vector<std::string> words = command(profile.path());
  words.insert(words.end(), options.begin(), options.end());
  words.push_back("file://" + fs::absolute(page).string());
  return run_program(words);
}

std::string decoded(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size()) {
      out += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

/// The page without the rule that forbids scripts, and with ours.
std::string with_script(const fs::path& page) {
  std::ifstream file(page, std::ios::binary);
  std::ostringstream stream;
  stream << file.rdbuf();
  std::string text = stream.str();
  const auto rule = text.find("<meta http-equiv");
  if (rule != std::string::npos) text.erase(rule, text.find('>', rule) + 1 - rule);
  const auto head = text.find("</head>");
  return head == std::string::npos ? text : text.insert(head, kMeasure);
}

}  // namespace

std::string browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
    if (run_program({"sh", "-c", std::string("command -v ") + name}).exit_code == 0) return name;
  return "";
}

nlohmann::json measured(const fs::path& page, int width, bool dark) {
  const Folder folder;
  folder.write("page.html", with_script(page));
  std::string frame = kFrame;
  frame.replace(frame.find('@'), 1, std::to_string(width));
  const Ended ended = browse(
      {"--window-size=1600,1300", std::string("--blink-settings=preferredColorScheme=") + (dark ? "0" : "1"), "--dump-dom"},
      folder.write("frame.html", frame));
  const std::string mark = "data-measured=\"";
  const auto from = ended.out.find(mark);
  if (from == std::string::npos) return {{"error", ended.err}};
  const auto begin = from + mark.size();
  return nlohmann::json::parse(decoded(ended.out.substr(begin, ended.out.find('"', begin) - begin)));
}

std::vector<std::string> console_lines(const fs::path& page) {
  const Ended ended = browse({"--enable-logging=stderr", "--dump-dom"}, page);
  std::vector<std::string> lines;
  std::istringstream text(ended.err);
  for (std::string line; std::getline(text, line);)
    if (line.find("CONSOLE") != std::string::npos) lines.push_back(line);
  if (ended.out.find("<main>") == std::string::npos) lines.push_back("the page was not shown: " + ended.err);
  return lines;
}

std::string printed(const fs::path& page) {
  const Folder folder;
  browse({"--no-pdf-header-footer", "--print-to-pdf=" + (folder.path() / "page.pdf").string()}, page);
  return folder.read("page.pdf");
}

}  // namespace bodeflow::test
