// The page in a real browser.
#include <cstdlib>
#include <fstream>

#include "catch.hpp"
#include "tools/live/devtools.hpp"
#include "tools/live/live_run.hpp"
#include "tools/report/browser.hpp"

using namespace bodeflow::test;

namespace {

constexpr const char* kGraph = BODEFLOW_SOURCE_DIR "/graphs/live/active_damping.yaml";

/// False, with the reason said: there is no browser.
bool has_browser() {
  if (!browser().empty()) return true;
  WARN("skipped: no Chromium was found");
  return false;
}

/// Types a value into a parameter's field and presses its button.
std::string set(const std::string& parameter, const std::string& value) {
  return "(() => { const form = document.querySelector('form[data-parameter=\"" + parameter +
         "\"]'); form.querySelector('input').value = '" + value + "'; form.querySelector('button').click(); return true; })()";
}

std::string text_of(const std::string& selector) { return "document.querySelector('" + selector + "').textContent"; }

/// For people who want to look: BODEFLOW_SCREENSHOTS is a folder.
void keep(Browser& page, const std::string& name) {
  if (const char* folder = std::getenv("BODEFLOW_SCREENSHOTS"))
    std::ofstream(std::string(folder) + "/" + name + ".png", std::ios::binary) << page.screenshot();
}

}  // namespace

TEST_CASE("live page in a browser: Bode plots come as they are measured, a parameter is changed, the end is shown") {
  if (!has_browser()) return;
  const Folder folder;
  LiveRun run(folder, kGraph, "run", {"--for", "14 s"});
  Browser page(browser(), 1200, 1000, false);
  page.open(run.address());
  REQUIRE(page.becomes("document.querySelectorAll('[data-record=\"response\"] svg').length >= 2"));
  CHECK(page.value(text_of("#badge")) == "running");
  CHECK(page.value("[...document.querySelectorAll('[data-record] svg text')].some(t => t.textContent === 'Coherence')") == true);
  CHECK(page.value("document.querySelectorAll('[data-record] svg .a0').length > 0") == true);  // a confidence band
  CHECK(page.becomes("[...document.querySelectorAll('[data-block=\"0\"]')].every(t => /kHz|Hz/.test(t.textContent))"));
  CHECK(page.value("document.querySelectorAll('#wires tr').length") == 8);
  CHECK(page.becomes("document.querySelectorAll('#bins i').length > 0"));
  CHECK(page.value(text_of("[data-now=\"damping.gain\"]")).get<std::string>().substr(0, 1) == "0");
  keep(page, "running");

  REQUIRE(page.value(set("noise.std", "-1")) == true);
  CHECK(page.becomes("/found .-1., allowed: at least 0/.test(" + text_of("form[data-parameter=\"noise.std\"] ~ .said") + ")"));
  REQUIRE(page.value(set("damping.gain", "0.02")) == true);
  REQUIRE(page.becomes("document.querySelectorAll('#changes tr.taken').length === 1"));
  CHECK(page.becomes(text_of("[data-now=\"damping.gain\"]") + ".startsWith('0.02')"));
  CHECK(page.value("document.documentElement.scrollWidth <= innerWidth") == true);
  keep(page, "changed");

  REQUIRE(page.becomes("document.documentElement.dataset.ended === 'complete'", 40.0));
  CHECK(page.value(text_of("#badge")) == "run complete");
  CHECK(page.value("[...document.querySelectorAll('form button')].every(b => b.disabled)") == true);
  CHECK(run.process().wait() == 0);
  for (const auto& complaint : page.complaints()) CHECK_THAT(complaint, Catch::Matchers::Contains("/change"));  // the one refused
  keep(page, "complete");
}

TEST_CASE("live page in a browser: fits a telephone in the dark, and without the token it only shows") {
  if (!has_browser()) return;
  const Folder folder;
  LiveRun run(folder, kGraph, "run", {"--for", "8 s"});
  Browser page(browser(), 390, 800, true);
  page.open(run.address().substr(0, run.address().find('#')));
  REQUIRE(page.becomes("document.querySelectorAll('[data-record=\"response\"] svg').length >= 2"));
  CHECK(page.value("document.documentElement.scrollWidth <= innerWidth") == true);
  CHECK(page.value("getComputedStyle(document.body).backgroundColor") == "rgb(21, 24, 28)");
  CHECK(page.value("[...document.querySelectorAll('form button')].every(b => b.disabled)") == true);
  CHECK(page.value("document.getElementById('read-only').hidden") == false);
  keep(page, "telephone");
  CHECK(run.process().wait() == 0);
}
