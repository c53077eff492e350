// SPDX-License-Identifier: Apache-2.0
//
// extractCode PAGE OUTPUT: the program of a page of the guide.
//
// It is what the page shows as C++, block after block, with what stands between in comments that
// begin with "<!-- code" and are not shown: the frame of the program, and what it checks.  Includes
// come first, whichever block they stand in.  Compilers name the lines of the page.

#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

namespace {

int fail(std::string const &what) {
    std::cerr << "extractCode: " << what << "\n";
    return 1;
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 3) {
        return fail("usage: extractCode PAGE OUTPUT");
    }
    std::ifstream page(argv[1]);
    if (!page) {
        return fail(std::string("cannot read ") + argv[1]);
    }
    std::ostringstream includes;
    std::ostringstream code;
    std::string end; // of the block that is being read; empty: of none
    std::string line;
    bool isShown = false;
    for (int number = 1; std::getline(page, line); ++number) {
        if (end.empty()) {
            if (line == "```cpp" || line == "<!-- code") {
                end = line == "```cpp" ? "```" : "-->";
                isShown = isShown || line == "```cpp";
                code << "#line " << number + 1 << " \"" << argv[1] << "\"\n";
            }
        } else if (line == end) {
            end.clear();
        } else if (line.rfind("#include", 0) == 0) {
            includes << "#line " << number << " \"" << argv[1] << "\"\n" << line << "\n";
            code << "\n";
        } else {
            code << line << "\n";
        }
    }
    if (!end.empty() || !isShown) {
        return fail(argv[1] +
                    std::string(end.empty() ? " shows no C++" : " has a block without end"));
    }
    std::ofstream output(argv[2]);
    output << includes.str() << code.str();
    output.close();
    return output ? 0 : fail(std::string("cannot write ") + argv[2]);
}
