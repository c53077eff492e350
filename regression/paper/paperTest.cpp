// SPDX-License-Identifier: Apache-2.0
//
// Runs the program that makes the report, with little work, and looks at the page.
#include "tools/mesh/testFolder.h"

#include <png.h>

#include <algorithm>
#include <cctype>

namespace OpenSubdivHex::Regression::paperTest {

namespace {

/// Occurrences of \p word.
int count(std::string const &text, std::string const &word) {
    int number = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        ++number;
    }
    return number;
}

/// Occurrences of \p word with no letter beside it.
int countAlone(std::string const &text, std::string const &word) {
    auto const isLetter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
    int number = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        std::size_t const end = at + word.size();
        bool const isAlone =
            (at == 0 || !isLetter(text[at - 1])) && (end == text.size() || !isLetter(text[end]));
        number += isAlone ? 1 : 0;
    }
    return number;
}

std::string decodeBase64(std::string const &text) {
    std::string const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0;
    int numBits = 0;
    for (char c : text.substr(0, text.find('='))) {
        EXPECT_NE(digits.find(c), std::string::npos) << c;
        bits = (bits << 6 | unsigned(digits.find(c))) & 0xffffffu;
        numBits += 6;
        if (numBits >= 8) {
            numBits -= 8;
            bytes += char(bits >> numBits & 255);
        }
    }
    return bytes;
}

class Paper : public Tools::TestFolder {
protected:
    int run(std::string const &arguments) const { return runProgram(PAPER_PROGRAM, arguments); }
};

} // namespace

TEST_F(Paper, PageIsComplete) {
    constexpr int kWidth = 40;
    ASSERT_EQ(run("-o \"" + getPath("index.html") +
                  "\" --width 40 --samples 1 --solid-level 2 --mask-level 2 --smoothness-level 2"
                  " --curvature-level 2 --timing-level 2 --rounds 1"),
              0)
        << getContent(getPath("stderr"));
    std::string page = getContent(getPath("index.html"));
    EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0u);
    EXPECT_EQ(page.substr(page.size() - 8), "</html>\n");

    for (std::string const id :
         {"claims", "solid", "meshes", "factors", "counts", "eigenvalues", "smoothness", "tips",
          "evenness", "models", "masks", "timing", "stage3"}) {
        EXPECT_EQ(count(page, "<section id=\"" + id + "\">"), 1) << id;
        EXPECT_EQ(count(page, "href=\"#" + id + "\""), 1) << id;
    }
    EXPECT_EQ(count(page, "<section"), count(page, "</section>"));
    EXPECT_EQ(count(page, "<figcaption>"), 15);

    // Pictures: 2 x 3 levels, 2 x 4 meshes, 3 tips, 3 x 3 even shapes, 2 x 4 models, 3 x 3 masks, 3 boxes, each a
    // PNG of its size.
    int numPictures = 0;
    for (std::size_t at = page.find("<img"); at != std::string::npos; at = page.find("<img")) {
        std::string const element = page.substr(at, page.find('>', at) + 1 - at);
        std::size_t const comma = element.find("base64,") + 7;
        std::string const bytes = decodeBase64(element.substr(comma, element.size() - 2 - comma));
        png_image png = {};
        png.version = PNG_IMAGE_VERSION;
        ASSERT_TRUE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()))
            << png.message;
        EXPECT_EQ(int(png.width), kWidth);
        EXPECT_NE(element.find("height=\"" + std::to_string(png.height) + "\""), std::string::npos);
        std::vector<png_byte> pixels(PNG_IMAGE_SIZE(png));
        ASSERT_TRUE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr)) << png.message;
        EXPECT_NE(*std::min_element(pixels.begin(), pixels.end()),
                  *std::max_element(pixels.begin(), pixels.end()));
        page.erase(at, element.size());
        ++numPictures;
    }
    EXPECT_EQ(numPictures, 6 + 8 + 3 + 9 + 8 + 9 + 3);

    // Drawings: two lattices, three maps and 2 + 2 + 4 + 6 + 2 plots.
    EXPECT_EQ(count(page, "<svg"), 2 + 3 + 16);
    EXPECT_EQ(count(page, "<svg"), count(page, "</svg>"));
    EXPECT_GT(count(page, "<path"), 300);
    for (char const *word : {"nan", "inf", "NaN"}) {
        EXPECT_EQ(countAlone(page, word), 0) << word;
    }

    // Results that depend neither on the machine nor on how much was computed.
    EXPECT_EQ(count(page, "class=\"off\""), 0);
    EXPECT_EQ(count(page, "class=\"ok\""), 6);
    EXPECT_EQ(count(page, "class=\"chip "), 15);
    EXPECT_NE(page.find("<td>8</td><td>1.0759; "), std::string::npos);
    EXPECT_NE(page.find("<td>1</td><td>122, 192, 72</td><td>116, 216, 102</td><td>2</td>"
                        "<td>96</td>"),
              std::string::npos);
    EXPECT_NE(page.find("13 4 1 1 1 4 / 24</td>"
                        "<td>1.0000, 0.6250, 0.6250, 0.3750, 0.3750, 0.2500</td>"),
              std::string::npos);
    EXPECT_NE(page.find("factor is 1.00 everywhere"), std::string::npos);
    EXPECT_EQ(listFiles(), (std::vector<std::string>{"index.html", "stderr", "stdout"}));
}

TEST_F(Paper, RefusesWhatCannotBeWritten) {
    std::filesystem::create_symlink("loop.html", getPath("loop.html"));
    for (std::string const &path : {getPath("missing/a.html"), getPath("loop.html")}) {
        EXPECT_EQ(run("-o " + path), 1);
        std::string const message = getContent(getPath("stderr"));
        EXPECT_EQ(message.rfind("paper: " + path + ": cannot be written", 0), 0u) << message;
        EXPECT_EQ(getContent(getPath("stdout")), "");
    }
}

TEST_F(Paper, RefusesBadUsage) {
    EXPECT_EQ(run(""), 2);
    EXPECT_NE(getContent(getPath("stderr")).find("--output"), std::string::npos);
    EXPECT_EQ(run("-o a.html --solid-level 0"), 2);
    EXPECT_EQ(run("-o a.html --rounds x"), 2);
}

} // namespace OpenSubdivHex::Regression::paperTest
