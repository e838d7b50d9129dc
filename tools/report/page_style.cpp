#include "report/page_style.hpp"

#include "report/picture.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr const char* kLight = R"(:root{--ground:#fff;--ink:#1a1d21;--quiet:#4a5058;--line:#d9dde2;--soft:#f5f6f8;--link:#00609a;
--warn:#8a4b00;--warn-ground:#fff5e6;--warn-line:#e08a00;--bad:#a32014;--bad-ground:#fdeeec;--bad-line:#c8371f;--good:#006b4f;--good-ground:#e8f6f1}
)";

constexpr const char* kDark =
    R"(:root{--ground:#15181c;--ink:#e8eaed;--quiet:#b4bac2;--line:#363c44;--soft:#1e2227;--link:#7cc4f0;
--warn:#ffc778;--warn-ground:#2c2213;--warn-line:#d98e1f;--bad:#ff9c8d;--bad-ground:#331a17;--bad-line:#e2604c;--good:#5fd6b2;--good-ground:#12291f}
)";

constexpr const char* kPage = R"(*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%;scroll-padding-top:1rem}
body{margin:0;background:var(--ground);color:var(--ink);font:16px/1.5 system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue','Noto Sans','DejaVu Sans',sans-serif;overflow-wrap:anywhere}
.layout{max-width:61rem;margin:0 auto;padding:2rem 1.25rem 4rem}
nav{display:none}
h1{font-size:1.75rem;line-height:1.2;margin:.1rem 0 .6rem;letter-spacing:-.01em;text-wrap:balance}
h2{font-size:1.3rem;line-height:1.3;margin:3rem 0 .75rem;padding-top:.9rem;border-top:1px solid var(--line)}
h3{font-size:1.02rem;margin:1.75rem 0 .5rem}
p{margin:.5rem 0;max-width:48rem}
a{color:var(--link)}
.over{color:var(--quiet);font-size:.85rem;margin:0}
.kind{font-size:.8rem;font-weight:400;color:var(--quiet);margin-left:.35rem;white-space:nowrap}
.badge{display:inline-block;font-size:.85rem;font-weight:600;padding:.1rem .6rem;border-radius:1rem;background:var(--soft);color:var(--quiet)}
.badge.complete{background:var(--good-ground);color:var(--good)}.badge.partial{background:var(--warn-ground);color:var(--warn)}.badge.failed{background:var(--bad-ground);color:var(--bad)}
.reason{color:var(--bad);font-weight:600}
dl{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,10.5rem),1fr));gap:.55rem 1.5rem;margin:.75rem 0 1rem;font-variant-numeric:tabular-nums}
dt{font-size:.78rem;color:var(--quiet)}dd{margin:0}
.caption,figcaption{font-size:.875rem;color:var(--quiet);max-width:48rem;margin:.35rem 0 0}
figcaption b{color:var(--ink);font-weight:600}
figure{margin:1.25rem 0 1.5rem}
.fig{display:block;max-width:100%;height:auto}
.wide .fig{width:100%}.narrow{display:none}
.grid{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,20rem),1fr));gap:.25rem 1.5rem;margin:1rem 0 .25rem}
.grid figure{margin:.5rem 0;display:flex;flex-direction:column-reverse;justify-content:flex-end}.grid .fig{width:100%}.grid figcaption{margin:0 0 .35rem}
.scroll{overflow-x:auto;max-width:100%;margin:.75rem 0}
.scroll:focus-visible{outline:2px solid var(--link);outline-offset:2px}
.natural .fig{max-width:none;width:auto}
table{border-collapse:collapse;font-size:.875rem;font-variant-numeric:tabular-nums;overflow-wrap:normal}
caption{text-align:left;font-weight:600;padding:.25rem 0 .4rem}
th,td{padding:.28rem .9rem .28rem 0;border-bottom:1px solid var(--line);vertical-align:top;text-align:left}
thead th{color:var(--quiet);font-weight:500;border-bottom:1px solid var(--quiet);vertical-align:bottom}
tbody th{font-weight:400}tbody th.w{min-width:9.5rem}td.w.s{min-width:15rem}
.n{text-align:right;white-space:nowrap}td.w,th.w{max-width:34rem;overflow-wrap:anywhere;min-width:5.5rem}
th.n:first-child{text-align:left}
details{margin:.75rem 0;border:1px solid var(--line);border-radius:6px;padding:.5rem .9rem}
summary{cursor:pointer;font-weight:500}details[open] summary{margin-bottom:.5rem}
ul.warnings{list-style:none;margin:0;padding:0}
ul.warnings li,.note{border-left:4px solid var(--warn-line);background:var(--warn-ground);padding:.55rem .9rem;margin:.5rem 0;border-radius:0 6px 6px 0;max-width:none}
ul.warnings li.bad{border-color:var(--bad-line);background:var(--bad-ground)}
ul.warnings b{display:block;font-size:.82rem;color:var(--warn)}ul.warnings li.bad b{color:var(--bad)}
code,pre{font:.84rem/1.5 ui-monospace,SFMono-Regular,Menlo,Consolas,'DejaVu Sans Mono',monospace}
pre{background:var(--soft);border-radius:6px;padding:.7rem .9rem;margin:.5rem 0;overflow-x:auto;white-space:pre-wrap}
.poly{font-variant-numeric:tabular-nums;overflow-x:auto}
footer{margin-top:3rem;padding-top:1rem;border-top:1px solid var(--line);font-size:.85rem;color:var(--quiet)}
@media (max-width:640px){.layout{padding:1.1rem .9rem 3rem}h1{font-size:1.4rem}h2{font-size:1.15rem;margin-top:2.25rem}
.wide{display:none}.narrow{display:block}.narrow .fig{width:100%}.natural .fig{width:auto}dl{grid-template-columns:repeat(auto-fill,minmax(min(100%,9rem),1fr))}}
@media (min-width:1280px){.layout{max-width:77rem;display:grid;grid-template-columns:13rem minmax(0,1fr);gap:2.5rem}
nav{display:block;position:sticky;top:2rem;align-self:start;max-height:calc(100vh - 4rem);overflow-y:auto;font-size:.875rem}
nav ol{list-style:none;margin:0;padding:0;border-left:1px solid var(--line)}nav a{display:block;padding:.2rem 0 .2rem .9rem;color:var(--quiet);text-decoration:none}nav a:hover{color:var(--link)}}
@page{size:A4;margin:16mm 15mm;@bottom-right{content:counter(page);font:9pt sans-serif;color:#4a5058}}
@media print{body{font-size:10.5pt}.layout{display:block;max-width:none;padding:0}nav,.csv{display:none}.wide{display:block}.narrow{display:none}
h1{font-size:18pt}h2{font-size:13pt;margin-top:1.5rem;break-after:avoid}h3{break-after:avoid}
figure,tr,dl>div,ul.warnings li{break-inside:avoid}caption{break-after:avoid}thead{display:table-header-group}
.scroll,pre{overflow:visible}.natural .fig{max-width:100%}.grid{grid-template-columns:1fr 1fr}details{border:0;padding:0}
*{-webkit-print-color-adjust:exact;print-color-adjust:exact}}
)";

}  // namespace

std::string page_style() {
  // Paper is white: the dark colours are for screens alone
  return std::string(kLight) + kPage + figure_style(false) + "\n@media screen and (prefers-color-scheme:dark){" + kDark +
         figure_style(true) + "}\n";
}

}  // namespace bodeflow::tools::report
