// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PAPER_PAGE_H
#define OPENSUBDIVHEX_REGRESSION_PAPER_PAGE_H

#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \p value with \p digits after the point.
std::string FormatNumber(double value, int digits);
/// \p value with spaces between thousands.
std::string FormatCount(long long value);

/// How a claim of the paper fares.
enum class Verdict { Holds, HoldsWithCondition, Fails };

/// Holds if \p holds; with a condition if only \p holdsWithCondition; else not.
Verdict Judge(bool holds, bool holdsWithCondition = false);

/// \brief A table of a page; cells are HTML.
struct Table {
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;
    std::string caption;
};

/// \brief A self-contained HTML page, written from top to bottom.  Texts are HTML.
class Page {
public:
    Page(std::string title, std::string lead);

    /// Begins a section, which the table of contents lists.
    void BeginSection(std::string const &id, std::string const &title);
    void AddParagraph(std::string const &text);
    void AddTable(Table const &table);
    /// Images and drawings side by side, \p numColumns in a row, with one caption.
    void AddFigure(std::vector<std::string> const &parts, int numColumns,
                   std::string const &caption);
    /// A row of the table of claims, which stands at the top of the page.
    void AddClaim(std::string const &claim, Verdict verdict, std::string const &evidence);

    /// The whole document.
    std::string Finish() const;

private:
    std::string _title;
    std::string _lead;
    std::string _contents;
    std::string _claims;
    std::string _body;
    int _numFigures = 0;
    bool _isInSection = false;
};

/// A part of a figure: \p content with a short text below.
std::string Captioned(std::string const &content, std::string const &text);

} // namespace OpenSubdivHex::Regression

#endif
