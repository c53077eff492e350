// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_PROGRAM_H
#define OPENSUBDIVHEX_TOOLS_PROGRAM_H

#include "fileError.h"
#include "meshFormat.h"
#include "meshReader.h"
#include "meshText.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

namespace OpenSubdivHex::Tools {

enum ExitCode { kSuccess = 0, kFailure = 1, kBadUsage = 2 };

/// \brief Help with descriptions behind the options, in lines of kWidth characters at most.
class HelpFormatter : public CLI::Formatter {
public:
    static constexpr std::size_t kWidth = 99; ///< of a line

    HelpFormatter() { column_width(kIndent); }

    std::string make_option(CLI::Option const *option, bool isPositional) const override {
        std::string const head =
            "  " + make_option_name(option, isPositional) + make_option_opts(option);
        std::string text;
        for (std::string const &line : wrap(head, kWidth - 4)) {
            text += (text.empty() ? "" : "\n    ") + line;
        }
        std::vector<std::string> const lines = wrap(make_option_desc(option), kWidth - kIndent);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            bool const isBeside = i == 0 && head.size() + 1 < kIndent;
            text += isBeside ? std::string(kIndent - head.size(), ' ')
                             : "\n" + std::string(kIndent, ' ');
            text += lines[i];
        }
        return text + "\n";
    }

    std::string make_usage(CLI::App const *app, std::string name) const override {
        std::string text;
        for (std::string const &line : wrap(CLI::Formatter::make_usage(app, name), kWidth)) {
            text += line + "\n";
        }
        return text;
    }

private:
    static constexpr std::size_t kIndent = 30; ///< of descriptions

    /// Breaks a text at spaces, and at commas of what is longer than a line, and at its line ends.
    static std::vector<std::string> wrap(std::string const &text, std::size_t width) {
        std::vector<std::string> lines;
        std::size_t begin = 0;
        while (begin < text.size()) {
            std::size_t const end = (std::min)(text.find('\n', begin), text.size());
            std::size_t next = end;
            if (end - begin > width) {
                std::size_t const space = text.rfind(' ', begin + width);
                std::size_t const comma = text.rfind(',', begin + width - 1);
                next = space != std::string::npos && space > begin + width / 3 ? space
                       : comma != std::string::npos && comma > begin           ? comma + 1
                                                                               : begin + width;
            }
            lines.push_back(text.substr(begin, next - begin));
            begin =
                next + (next < text.size() && (text[next] == ' ' || text[next] == '\n') ? 1 : 0);
        }
        return lines;
    }
};

/// Throws FileError where what was written to standard output has not come there.
inline void FlushOutput() {
    if (!std::cout.flush()) {
        throw FileError("standard output", "cannot be written");
    }
}

/// Prints "PROGRAM: FILE: warning: TEXT", one line, to standard error.
inline void PrintWarning(std::string const &program, std::string const &path,
                         std::string const &text) {
    std::cerr << program << ": " << EscapeControls(path + ": warning: " + text) << "\n";
}

/// Prints "PROGRAM: FILE: hint: TEXT", one line, to standard error.
inline void PrintHint(std::string const &program, std::string const &path,
                      std::string const &text) {
    std::cerr << program << ": " << EscapeControls(path + ": hint: " + text) << "\n";
}

/// The mesh that a program reads, as by ReadMesh(); prints the warnings.
inline Mesh ReadInput(std::string const &program, std::string const &path) {
    Mesh mesh = ReadMesh(path);
    for (std::string const &warning : mesh.warnings) {
        PrintWarning(program, path, warning);
    }
    return mesh;
}

/// \brief The body of main: reads the command line into \p app, calls work() and returns the exit code.
///
/// Any exception ends the program with one line, "PROGRAM: cause"; a CLI::ParseError, which
/// work may throw too, with CLI11's text behind the name.
template <typename WORK>
int RunProgram(CLI::App &app, int argc, char const *const *argv, WORK work) {
    auto const fail = [&](std::string const &cause) {
        std::cerr << app.get_name() << ": " << EscapeControls(cause) << "\n";
        return kFailure;
    };
    app.formatter(std::make_shared<HelpFormatter>());
    app.failure_message([](CLI::App const *failed, CLI::Error const &error) {
        return failed->get_name() + ": " + EscapeControls(error.what()) + "\nRun " +
               failed->get_name() + " with --help for more information.\n";
    });
    try {
        try {
            app.parse(argc, argv);
            work();
        } catch (CLI::ParseError const &error) {
            if (app.exit(error) != 0) {
                return kBadUsage;
            }
            FlushOutput(); // help, or the version
        }
    } catch (std::bad_alloc const &) {
        return fail("not enough memory");
    } catch (std::exception const &error) {
        return fail(error.what());
    } catch (...) {
        return fail("an error that says nothing of itself");
    }
    return kSuccess;
}

/// CLI::Range, but that NaN is not in it.
inline CLI::Validator MakeRange(double min, double max) {
    CLI::Range const range(min, max);
    return {[=](std::string const &word) {
                float number = 0;
                return ParseFiniteFloat(word, &number)
                           ? range(word)
                           : "'" + word + "' is " + NameFloatFailure(word);
            },
            range.get_description()};
}

/// \brief Checks that a word is a float between \p least and \p most, and none of these.
///
/// \param what  such a number, for messages
inline CLI::Validator MakeOpenRange(float least, float most, std::string const &what) {
    auto const check = [=](std::string const &word) {
        float number = 0;
        if (!ParseFiniteFloat(word, &number)) {
            return "'" + word + "' is " + NameFloatFailure(word);
        }
        if (number > least && number < most) {
            return std::string();
        }
        // One that rounding takes there.
        double exact = 0;
        bool const isRounded =
            CLI::detail::lexical_cast(word, exact) && exact > double(least) && exact < double(most);
        return "'" + word + "' is " +
               (isRounded ? CLI::detail::to_string(number) + " as a float, " : std::string()) +
               "not " + what;
    };
    return {check, ""};
}

/// Checks that a word is a float above 0.
inline CLI::Validator MakePositive() {
    return MakeOpenRange(0, std::numeric_limits<float>::infinity(), "a number above 0");
}

/// Checks that a word is the name of a file that WriteMesh() writes.
inline CLI::Validator MakeMeshFile() {
    return {[](std::string const &word) {
                return FindMeshFormat(word)
                           ? std::string()
                           : "'" + word + "' is not a " + kMeshExtensions + " file";
            },
            ""};
}

/// Checks that a word is the name of a .png file.
inline CLI::Validator MakePngFile() {
    return {[](std::string const &word) {
                return std::filesystem::path(word).extension() == ".png"
                           ? std::string()
                           : "'" + word + "' is not a .png file";
            },
            ""};
}

/// \brief The numbers in the argument of the option \p name: \p least to \p most finite ones with commas
/// between them.  Throws CLI::ValidationError.
inline std::vector<float> ReadNumbers(std::string const &name, std::string const &argument,
                                      std::size_t least, std::size_t most) {
    std::vector<float> numbers;
    std::string_view rest = argument;
    for (std::size_t end = 0; end != std::string_view::npos;) {
        end = rest.find(',');
        std::string_view const word = rest.substr(0, end);
        if (!ParseFiniteFloat(word, &numbers.emplace_back())) {
            throw CLI::ValidationError(name,
                                       "'" + std::string(word) + "' is " + NameFloatFailure(word));
        }
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    if (numbers.size() < least || numbers.size() > most) {
        throw CLI::ValidationError(
            name, "'" + argument + "' has " + std::to_string(numbers.size()) + " numbers, not " +
                      std::to_string(least) +
                      (most > least ? " to " + std::to_string(most) : std::string()));
    }
    return numbers;
}

/// \brief Adds an option whose argument, as ReadNumbers() has it, replaces \p numbers.  Lists of CLI11 take
/// what comes behind them, too.
inline CLI::Option *AddNumbers(CLI::App &app, std::string const &name, std::vector<float> *numbers,
                               std::size_t least, std::size_t most,
                               std::string const &description) {
    auto const read = [=](std::string const &argument) {
        *numbers = ReadNumbers(name, argument, least, most);
    };
    return app.add_option_function<std::string>(name, read, description);
}

} // namespace OpenSubdivHex::Tools

#endif
