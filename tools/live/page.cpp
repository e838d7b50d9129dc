#include "live/page.hpp"

#include "report/markup.hpp"
#include "report/page_style.hpp"

namespace bodeflow::tools::live {
namespace {

constexpr const char* kStyle = R"(.layout{display:block;max-width:61rem}
.bar{height:.5rem;border-radius:.25rem;background:var(--soft);overflow:hidden;margin:.75rem 0;border:1px solid var(--line)}
.bar>div{height:100%;width:0;background:var(--link)}
.badge.running{background:var(--soft);color:var(--link)}
input,select,button{font:inherit;color:inherit;background:var(--ground);border:1px solid var(--quiet);border-radius:4px;padding:.2rem .5rem;max-width:100%}
input{width:9rem}button{cursor:pointer;background:var(--soft)}button:disabled,input:disabled,select:disabled{opacity:.5;cursor:default}
:is(input,select,button):focus-visible{outline:2px solid var(--link);outline-offset:1px}
form{display:flex;gap:.4rem;flex-wrap:wrap;margin:0}
.said{display:block;font-size:.85rem;min-height:1.25em}.said.bad{color:var(--bad)}.said.good{color:var(--good)}
.bins{display:grid;grid-template-columns:max-content 1fr max-content;gap:.1rem .75rem;font-size:.85rem;max-width:40rem;font-variant-numeric:tabular-nums}
.bins span:nth-child(3n+1),.bins span:nth-child(3n){text-align:right;color:var(--quiet)}
.bins i{display:block;height:.7rem;margin:.3rem 0;background:var(--link);min-width:1px}
meter{width:6rem;vertical-align:middle}
[hidden]{display:none!important}
ul.warnings{max-height:22rem;overflow-y:auto}ul.warnings li.info{border-color:var(--line);background:none}ul.warnings li.info b{color:var(--quiet)}
h3 .kind{font-size:.85rem}
@media (max-width:640px){.stack thead{display:none}.stack tr{display:block;padding:.5rem 0;border-bottom:1px solid var(--line)}
.stack td.w{display:block;border:0;padding:.1rem 0;min-width:0}.stack td{display:block;border:0;padding:.1rem 0}}
)";

constexpr const char* kBody = R"(<p class="over">bodeflow, live</p>
<h1 id="title"></h1>
<p><span id="badge" class="badge">waiting</span> <span id="where"></span></p>
<p id="reason" class="reason" hidden></p>
<div class="bar" role="progressbar" aria-label="Progress"><div id="progress"></div></div>
<dl id="figures"></dl>
<section><h2>Graph</h2><div id="graph"></div></section>
<section id="parameters-section" hidden><h2>Parameters</h2>
<p id="read-only" class="note" hidden>This page only shows. To change parameters open the address that the command printed, with what stands behind its #.</p>
<div class="scroll"><table class="stack"><thead><tr><th>Parameter</th><th>Now</th><th>Change to</th></tr></thead><tbody id="parameters"></tbody></table></div></section>
<section id="changes-section" hidden><h2>Changes</h2><div class="scroll"><table><thead><tr><th>Parameter</th><th class="n">Value</th><th class="n">From sample</th><th class="n">Time</th><th>What became of it</th></tr></thead><tbody id="changes"></tbody></table></div></section>
<section id="records-section" hidden><h2>Results so far</h2><div id="records"></div></section>
<section id="lateness-section" hidden><h2>Lateness</h2><p id="lateness"></p><div id="bins" class="bins"></div></section>
<section id="wires-section" hidden><h2>Connections</h2><div class="scroll"><table><thead><tr><th>From</th><th>To</th><th class="n">Rate</th><th class="n">Measured</th><th>Queue between threads</th></tr></thead><tbody id="wires"></tbody></table></div></section>
<section id="log-section" hidden><h2>Messages</h2><ul id="log" class="warnings"></ul></section>
)";

}  // namespace

std::string page_html(const std::string& title, const std::string& nonce) {
  report::Markup page;
  page.trusted("<!DOCTYPE html>\n").open("html", {{"lang", "en"}}).open("head").single("meta", {{"charset", "utf-8"}});
  page.single("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  page.single("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
  page.element("title", title + " – bodeflow, live").open("style").trusted(report::page_style()).trusted(kStyle).close("style");
  page.close("head")
      .trusted("\n")
      .open("body")
      .open("div", {{"class", "layout"}})
      .open("main")
      .trusted(kBody)
      .close("main")
      .close("div");
  page.open("script", {{"nonce", nonce}}).trusted(page_script()).close("script");
  return page.close("body").close("html").trusted("\n").str();
}

}  // namespace bodeflow::tools::live
