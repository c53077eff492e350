// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include "subdivisionPeer.h"

#include "osd_ext/simdLevel.h"

#include <nlohmann/json.hpp>
#include <opensubdiv/version.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

namespace OpenSubdivHex::Regression {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the text behind the first of \p separators in the first line that begins with \p begin,
/// without spaces and quotes around it.
std::string readValue(char const *path, std::string const &begin, char const *separators) {
    std::ifstream file(path);
    std::string line;
    while (std::getline(file, line)) {
        std::size_t const first = line.find_first_of(separators);
        if (line.compare(0, begin.size(), begin) == 0 && first != std::string::npos) {
            line = line.substr(std::min(line.find_first_not_of(" \"", first + 1), line.size()));
            return line.substr(0, line.find_last_not_of(" \"") + 1);
        }
    }
    return "unknown";
}

/// "madvise" and the like.
std::string getHugePages() {
    std::string const modes = readValue("/sys/kernel/mm/transparent_hugepage/enabled", "", "[");
    return modes.substr(0, modes.find(']'));
}

/// The load of the last minute; above 0 other processes were at work.
std::string getLoadAverage() {
    std::string load = "unknown";
    std::ifstream("/proc/loadavg") >> load;
    return load;
}

std::string getDate() {
    std::time_t const now = std::time(nullptr);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
    return text;
}

std::string getCompiler() {
#if defined(__clang__)
    return "Clang " __clang_version__;
#elif defined(__GNUC__)
    return "GCC " __VERSION__;
#else
    return "unknown";
#endif
}

std::string getSimdLevel() {
    switch (OsdExt::GetSimdLevel()) {
    case OsdExt::SimdLevel::Portable:
        return "portable";
    case OsdExt::SimdLevel::Avx2:
        return "AVX2";
    case OsdExt::SimdLevel::Avx512:
        return "AVX-512";
    }
    return "";
}

std::string formatNumber(double value) {
    if (std::isnan(value)) {
        return "-";
    }
    char text[32];
    std::snprintf(text, sizeof text, value < 9.95 ? "%.2f" : "%.1f", value);
    return text;
}

std::string formatPercent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.0f %%", 100 * share);
    return text;
}

/// A Markdown table whose columns are padded, so that it can be read as it is.
class TableText {
public:
    /// Names with a leading '>' are those of columns of numbers.
    explicit TableText(std::vector<std::string> const &columns) {
        _lines.emplace_back();
        for (std::string const &column : columns) {
            _isNumber.push_back(column[0] == '>');
            _lines[0].push_back(column.substr(_isNumber.back() ? 1 : 0));
        }
    }

    void AddLine(std::vector<std::string> line) { _lines.push_back(std::move(line)); }

    std::string Format() const {
        std::vector<std::size_t> widths(_isNumber.size(), 3);
        for (auto const &line : _lines) {
            for (std::size_t i = 0; i < line.size(); ++i) {
                widths[i] = std::max(widths[i], line[i].size());
            }
        }
        std::string text;
        for (auto const &line : _lines) {
            for (std::size_t i = 0; i < widths.size(); ++i) {
                std::string const cell = i < line.size() ? line[i] : "";
                std::string const padding(widths[i] - cell.size(), ' ');
                text += "| " + (_isNumber[i] ? padding + cell : cell + padding) + " ";
            }
            text += "|\n";
            if (&line == &_lines[0]) {
                for (std::size_t i = 0; i < widths.size(); ++i) {
                    text += "|" + (_isNumber[i] ? std::string(widths[i] + 1, '-') + ":"
                                                : std::string(widths[i] + 2, '-'));
                }
                text += "|\n";
            }
        }
        return text;
    }

private:
    std::vector<bool> _isNumber;
    std::vector<std::vector<std::string>> _lines;
};

void addName(std::vector<std::string> &names, std::string const &name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
        names.push_back(name);
    }
}

/// Returns the names that \p member gives the meshes of figures, each once, in order.
std::vector<std::string> getNames(Results const &results, std::string BenchMesh::*member) {
    std::vector<std::string> names;
    for (Figure const &figure : results.figures) {
        addName(names, figure.setting.mesh.*member);
    }
    return names;
}

/// The figure, and behind it that of the peer where it has one of its own.
std::string formatFigure(Figure const &figure) {
    return formatNumber(figure.value) +
           (figure.peerValue > 0 ? " (" + formatNumber(figure.peerValue) + ")" : "");
}

/// Bytes per second of memcpy on that many threads; 0 where it was not measured.
double getCopyBandwidth(Results const &results, int numThreads) {
    for (ContestResult const &result : results.contests) {
        for (Cost const &cost : result.costs) {
            if (result.setting.work == "copy" && cost.numThreads == numThreads) {
                return cost.bytesPerSecond;
            }
        }
    }
    return 0;
}

bool isGrowth(Setting const &setting) { return setting.mesh.size.rfind("level ", 0) == 0; }

/// The worst of some figures of a row.
double getWorst(Row const &row, std::vector<double> const &values) {
    double worst = values[0];
    for (double value : values) {
        bool const isWorse = row.isUpperBound ? value > worst : value < worst;
        worst = isWorse || std::isnan(value) ? value : worst;
    }
    return worst;
}

std::string formatRows(Results const &results) {
    std::vector<std::string> const meshNames = getNames(results, &BenchMesh::name);
    std::vector<std::string> columns = {"work", "peer", ">at least", ">aim", "size", "memory"};
    for (std::string const &name : meshNames) {
        columns.push_back(">" + name);
    }
    columns.emplace_back("verdict");
    TableText table(columns);
    for (Row const &row : *results.rows) {
        std::string const sign = row.isUpperBound ? "<= " : "";
        std::vector<std::string> const head = {row.work, row.peer, sign + formatNumber(row.atLeast),
                                               sign + formatNumber(row.aim)};
        bool isMeasured = false;
        for (Memory memory : {Memory::Default, Memory::Warm, Memory::Resident}) {
            for (std::string const &size : getNames(results, &BenchMesh::size)) {
                std::map<std::string, Figure> figures; // by mesh
                std::vector<double> values;
                for (Figure const &figure : results.figures) {
                    if (figure.row->name == row.name && figure.setting.memory == memory &&
                        figure.setting.mesh.size == size) {
                        figures.emplace(figure.setting.mesh.name, figure);
                        values.push_back(figure.value);
                    }
                }
                if (figures.empty()) {
                    continue;
                }
                isMeasured = true;
                std::vector<std::string> line = head;
                line.insert(line.end(), {size, GetName(memory)});
                for (std::string const &name : meshNames) {
                    auto const found = figures.find(name);
                    line.push_back(found == figures.end() ? "-" : formatFigure(found->second));
                }
                line.push_back(GetVerdict(row, getWorst(row, values)));
                table.AddLine(line);
            }
        }
        if (!isMeasured) {
            std::vector<std::string> line = head;
            line.resize(columns.size() - 1, "-");
            line.emplace_back("not measured");
            table.AddLine(line);
        }
    }
    return table.Format();
}

std::string formatCosts(Results const &results) {
    TableText table({"work", "mesh", "size", "memory", "who", ">threads", ">ns", "per", ">bytes",
                     ">of copy bandwidth"});
    for (ContestResult const &result : results.contests) {
        Setting const &setting = result.setting;
        if (isGrowth(setting)) {
            continue;
        }
        for (Cost const &cost : result.costs) {
            double const bandwidth = getCopyBandwidth(results, cost.numThreads);
            table.AddLine({setting.work, setting.mesh.name, setting.mesh.size,
                           GetName(setting.memory), cost.name, std::to_string(cost.numThreads),
                           formatNumber(cost.GetMedian()), setting.item,
                           cost.bytes >= 0.05 ? formatNumber(cost.bytes) : "",
                           bandwidth > 0 ? formatPercent(cost.bytesPerSecond / bandwidth) : ""});
        }
    }
    return table.Format();
}

constexpr char kGrowthIntroduction[] = R"(
## Growth

Nanoseconds per item of the levels of a mesh of 384 quads.

)";

/// Nothing where no growth was measured.
std::string formatGrowth(Results const &results) {
    std::vector<std::string> columns = {"work", "ns per", ">threads"};
    std::vector<std::string> sizes;
    for (ContestResult const &result : results.contests) {
        if (isGrowth(result.setting)) {
            addName(sizes, result.setting.mesh.size);
        }
    }
    if (sizes.empty()) {
        return "";
    }
    for (std::string const &size : sizes) {
        columns.push_back(">" + size);
    }
    TableText table(columns);
    std::vector<std::vector<std::string>> lines;
    for (ContestResult const &result : results.contests) {
        Setting const &setting = result.setting;
        if (!isGrowth(setting)) {
            continue;
        }
        for (Cost const &cost : result.costs) {
            std::vector<std::string> const head = {setting.work, setting.item,
                                                   std::to_string(cost.numThreads)};
            auto line = std::find_if(lines.begin(), lines.end(), [&](auto const &other) {
                return std::equal(head.begin(), head.end(), other.begin());
            });
            if (line == lines.end()) {
                line = lines.insert(lines.end(), head);
                line->resize(columns.size(), "-");
            }
            auto const size = std::find(sizes.begin(), sizes.end(), setting.mesh.size);
            (*line)[head.size() + std::size_t(size - sizes.begin())] =
                formatNumber(cost.GetMedian());
        }
    }
    for (auto const &line : lines) {
        table.AddLine(line);
    }
    return kGrowthIntroduction + table.Format();
}

Json toJson(Setting const &setting) {
    return {{"work", setting.work},
            {"mesh", setting.mesh.name},
            {"size", setting.mesh.size},
            {"level", setting.mesh.level},
            {"memory", GetName(setting.memory)}};
}

constexpr char kRatiosIntroduction[] = R"(
## Ratios

Own speed over that of the peer: the median of the ratios of turns, in which all contestants of a
benchmark run one after the other. The verdict is that of the worst of the meshes: *aim*, *at
least* or *below*. Bounds with `<=` are upper bounds, and figures in brackets are the peer's own.

)";

constexpr char kCostsIntroduction[] = R"(
## Costs

Medians. Bytes are those that stay allocated after the work, per item. The share of copy bandwidth
is that of the bytes that the work must move at least: what it leaves behind, or the table, sources
and results of an evaluation. memcpy counts what it reads and what it writes.

)";

/// JSON has no NaN.
Json toJson(double value) { return std::isnan(value) ? Json() : Json(value); }

} // namespace

Environment DescribeEnvironment() {
    return {{"date", getDate()},
            {"processor", readValue("/proc/cpuinfo", "model name", ":")},
            {"cores", std::to_string(std::thread::hardware_concurrency())},
            {"instructions of the evaluators", getSimdLevel()},
            {"load average", getLoadAverage()},
            {"huge pages", getHugePages()},
            {"system", readValue("/etc/os-release", "PRETTY_NAME", "=")},
            {"compiler", getCompiler()},
            {"OpenSubdiv", std::to_string(OPENSUBDIV_VERSION_MAJOR) + "." +
                               std::to_string(OPENSUBDIV_VERSION_MINOR) + "." +
                               std::to_string(OPENSUBDIV_VERSION_PATCH)},
            {"OpenMesh", GetOpenMeshVersion()},
            {"CGAL", GetCgalVersion()}};
}

std::string FormatMarkdown(Results const &results, Environment const &environment) {
    std::ostringstream text;
    text << "# " << results.title << "\n\n";
    for (auto const &[name, value] : environment) {
        text << "- " << name << ": " << value << "\n";
    }
    for (int numThreads : {1, 2}) {
        if (double const bandwidth = getCopyBandwidth(results, numThreads); bandwidth > 0) {
            text << "- copy bandwidth, " << numThreads
                 << (numThreads > 1 ? " threads: " : " thread: ") << formatNumber(bandwidth / 1e9)
                 << " GB/s\n";
        }
    }
    text << kRatiosIntroduction << results.conditions << "\n\n"
         << formatRows(results) << kCostsIntroduction << formatCosts(results)
         << formatGrowth(results);
    return text.str();
}

std::string FormatJson(Results const &results, Environment const &environment) {
    Json json;
    for (auto const &[name, value] : environment) {
        json["environment"][name] = value;
    }
    json["rows"] = Json::array();
    for (Row const &row : *results.rows) {
        Json figures = Json::array();
        for (Figure const &figure : results.figures) {
            if (figure.row->name == row.name) {
                Json entry = toJson(figure.setting);
                entry["figure"] = toJson(figure.value);
                if (figure.peerValue != 0) {
                    entry["peerFigure"] = toJson(figure.peerValue);
                }
                entry["verdict"] = GetVerdict(row, figure.value);
                figures.push_back(entry);
            }
        }
        json["rows"].push_back({{"name", row.name},
                                {"work", row.work},
                                {"peer", row.peer},
                                {"atLeast", row.atLeast},
                                {"aim", row.aim},
                                {"isUpperBound", row.isUpperBound},
                                {"figures", figures}});
    }
    json["costs"] = Json::array();
    for (ContestResult const &result : results.contests) {
        for (Cost const &cost : result.costs) {
            Json entry = toJson(result.setting);
            entry["who"] = cost.name;
            entry["threads"] = cost.numThreads;
            entry["item"] = result.setting.item;
            entry["nanoseconds"] = cost.GetMedian();
            entry["bytes"] = cost.bytes;
            entry["bytesPerSecond"] = cost.bytesPerSecond;
            double const bandwidth = getCopyBandwidth(results, cost.numThreads);
            entry["shareOfCopyBandwidth"] =
                bandwidth > 0 ? Json(cost.bytesPerSecond / bandwidth) : Json();
            json["costs"].push_back(entry);
        }
    }
    return json.dump(2) + "\n";
}

} // namespace OpenSubdivHex::Regression
