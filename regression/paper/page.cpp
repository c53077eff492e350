// SPDX-License-Identifier: Apache-2.0
#include "page.h"

#include <cmath>
#include <cstdio>

namespace OpenSubdivHex::Regression {

namespace {

constexpr char kStyle[] = R"(
:root { color-scheme: light dark; --back: #fbfaf8; --panel: #fff; --ink: #22242a; --soft: #666b76;
  --line: #dedbd5; --accent: #b4512a; --good: #2d7a4b; --middle: #98690c; --bad: #b03434;
  --c0: #b4512a; --c1: #2f6f9f; --c2: #3c8a57; --c3: #8b5fae; --c4: #b58a16; --c5: #6f7480;
  --c6: #c2508a; --c7: #22969a; }
@media (prefers-color-scheme: dark) { :root { --back: #17181b; --panel: #1f2125; --ink: #e4e2dd;
  --soft: #a0a4ad; --line: #373a41; --accent: #e58a5f; --good: #6cc48d; --middle: #dcae50;
  --bad: #ea8080; --c0: #e58a5f; --c1: #72b1de; --c2: #79c795; --c3: #bd97dc; --c4: #dcb84e;
  --c5: #a8adb8; --c6: #ea8dbb; --c7: #62c9cc; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--back); color: var(--ink);
  font: 17px/1.6 "Source Serif 4", Charter, Georgia, "DejaVu Serif", serif; }
main { max-width: 60rem; margin: 0 auto; padding: 3.5rem 1.5rem 6rem; }
h1, h2, h3, nav, table, figcaption, .chip, svg, .part {
  font-family: Inter, "Segoe UI", "Helvetica Neue", "DejaVu Sans", sans-serif; }
h1 { font-size: 2.1rem; line-height: 1.2; margin: 0 0 .8rem; letter-spacing: -.015em; }
h2 { font-size: 1.35rem; margin: 3.8rem 0 .9rem; padding-top: 1rem;
  border-top: 1px solid var(--line); letter-spacing: -.01em; }
p { margin: 0 0 1rem; max-width: 44rem; }
.lead { font-size: 1.12rem; color: var(--soft); max-width: 46rem; }
nav { font-size: .84rem; margin: 1.6rem 0 0; line-height: 2; }
nav a { color: var(--soft); text-decoration: none; margin-right: 1.1rem; white-space: nowrap; }
nav a:hover { color: var(--accent); }
figure { margin: 1.6rem 0 2rem; }
.grid { display: grid; gap: .8rem; align-items: start; }
.grid img, .grid svg { width: 100%; height: auto; display: block; border-radius: 6px; }
.grid svg { background: var(--panel); border: 1px solid var(--line); }
.part { font-size: .78rem; color: var(--soft); text-align: center; margin-top: .3rem; }
figcaption, caption { font-size: .84rem; color: var(--soft); line-height: 1.5; margin-top: .7rem;
  max-width: 50rem; }
figcaption b { color: var(--ink); }
.wide { overflow-x: auto; margin: 1.4rem 0 1.8rem; }
table { border-collapse: collapse; font-size: .84rem; line-height: 1.45; min-width: 50%;
  font-variant-numeric: tabular-nums; }
caption { caption-side: bottom; text-align: left; }
th { text-align: left; font-weight: 600; border-bottom: 2px solid var(--line);
  padding: .35rem .8rem .35rem 0; vertical-align: bottom; }
td { border-bottom: 1px solid var(--line); padding: .35rem .8rem .35rem 0; vertical-align: top; }
.numbers td:not(:first-child), .numbers th:not(:first-child) { text-align: right; }
.claims td:first-child { width: 30%; font-weight: 600; }
.chip { display: inline-block; padding: .05rem .6rem; border-radius: 99px; font-size: .74rem;
  font-weight: 600; white-space: nowrap; border: 1px solid currentColor; }
.holds { color: var(--good); } .condition { color: var(--middle); } .fails { color: var(--bad); }
.ok { color: var(--good); } .off { color: var(--bad); font-weight: 700; }
svg text { fill: var(--ink); font-size: 11px; } svg .soft { fill: var(--soft); }
svg .title { font-size: 12.5px; font-weight: 600; }
svg .axis { stroke: var(--line); stroke-width: 1; fill: none; }
)";

char const *getChip(Verdict verdict) {
    switch (verdict) {
    case Verdict::Holds:
        return "<span class=\"chip holds\">holds</span>";
    case Verdict::HoldsWithCondition:
        return "<span class=\"chip condition\">with a condition</span>";
    case Verdict::Fails:
        return "<span class=\"chip fails\">does not hold</span>";
    }
    return "";
}

} // namespace

std::string FormatNumber(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

std::string FormatCount(long long value) {
    std::string text = std::to_string(value);
    for (int place = int(text.size()) - 3; place > 0; place -= 3) {
        text.insert(std::size_t(place), "&#8239;");
    }
    return text;
}

Verdict Judge(bool holds, bool holdsWithCondition) {
    return holds                ? Verdict::Holds
           : holdsWithCondition ? Verdict::HoldsWithCondition
                                : Verdict::Fails;
}

std::string Captioned(std::string const &content, std::string const &text) {
    return content + "<div class=\"part\">" + text + "</div>";
}

Page::Page(std::string title, std::string lead)
    : _title(std::move(title)), _lead(std::move(lead)) {}

void Page::BeginSection(std::string const &id, std::string const &title) {
    _body += _isInSection ? "</section>\n" : "";
    _isInSection = true;
    _body += "<section id=\"" + id + "\">\n<h2>" + title + "</h2>\n";
    _contents += "<a href=\"#" + id + "\">" + title + "</a> ";
}

void Page::AddParagraph(std::string const &text) { _body += "<p>" + text + "</p>\n"; }

void Page::AddTable(Table const &table) {
    _body += "<div class=\"wide\"><table class=\"numbers\">";
    _body += table.caption.empty() ? "" : "<caption>" + table.caption + "</caption>";
    _body += "<thead><tr>";
    for (std::string const &cell : table.header) {
        _body += "<th>" + cell + "</th>";
    }
    _body += "</tr></thead><tbody>\n";
    for (std::vector<std::string> const &row : table.rows) {
        _body += "<tr>";
        for (std::string const &cell : row) {
            _body += "<td>" + cell + "</td>";
        }
        _body += "</tr>\n";
    }
    _body += "</tbody></table></div>\n";
}

void Page::AddFigure(std::vector<std::string> const &parts, int numColumns,
                     std::string const &caption) {
    _body += "<figure><div class=\"grid\" style=\"grid-template-columns: repeat(" +
             std::to_string(numColumns) + ", minmax(0, 1fr))\">\n";
    for (std::string const &part : parts) {
        _body += "<div>" + part + "</div>\n";
    }
    _body += "</div><figcaption><b>Figure " + std::to_string(++_numFigures) + ".</b> " + caption +
             "</figcaption></figure>\n";
}

void Page::AddClaim(std::string const &claim, Verdict verdict, std::string const &evidence) {
    _claims += "<tr><td>" + claim + "</td><td>" + getChip(verdict) + "</td><td>" + evidence +
               "</td></tr>\n";
}

std::string Page::Finish() const {
    std::string page = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
                       "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                       "<title>" +
                       _title + "</title>\n<style>" + kStyle + "</style></head>\n<body><main>\n";
    page += "<h1>" + _title + "</h1>\n<p class=\"lead\">" + _lead + "</p>\n";
    page += "<nav><a href=\"#claims\">The claims</a> " + _contents + "</nav>\n";
    page += "<section id=\"claims\">\n<h2>The claims</h2>\n<div class=\"wide\">"
            "<table class=\"claims\"><thead><tr><th>The paper says</th><th>Here</th>"
            "<th>Because</th></tr></thead><tbody>\n" +
            _claims + "</tbody></table></div>\n</section>\n";
    return page + _body + (_isInSection ? "</section>\n" : "") + "</main></body></html>\n";
}

} // namespace OpenSubdivHex::Regression
