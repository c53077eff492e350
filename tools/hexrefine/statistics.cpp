// SPDX-License-Identifier: Apache-2.0
#include "statistics.h"

#include "normals.h"
#include "tagText.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshText.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <set>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#endif

namespace OpenSubdivHex::Tools {

std::vector<LevelStatistics> CountLevels(FarExt::TopologyRefiner const &refiner) {
    std::vector<LevelStatistics> levels;
    for (int i = 0; i < refiner.GetNumLevels(); ++i) {
        FarExt::TopologyLevel const &level = refiner.GetLevel(i);
        std::map<int, int> facesBySize;
        for (int f = 0; f < level.GetNumFaces(); ++f) {
            ++facesBySize[level.GetFaceVertices(f).size()];
        }
        levels.push_back({level.GetNumVertices(), level.GetNumEdges(), level.GetNumFaces(),
                          level.GetNumFaceVertices(), level.GetNumBoundaryEdges(), facesBySize});
    }
    return levels;
}

std::vector<int> CountHoles(FarExt::TopologyRefiner const &refiner) {
    std::vector<int> holes;
    for (int i = 0; i < refiner.GetNumLevels(); ++i) {
        FarExt::TopologyLevel const &level = refiner.GetLevel(i);
        holes.push_back(0);
        for (int f = 0; f < level.GetNumFaces(); ++f) {
            holes.back() += level.IsFaceHole(f) ? 1 : 0;
        }
    }
    return holes;
}

std::vector<ChannelStatistics> CountChannels(FarExt::TopologyRefiner const &refiner,
                                             Mesh const &mesh) {
    std::vector<ChannelStatistics> channels;
    for (FVarChannel const &channel : mesh.channels) {
        std::vector<int> values;
        values.reserve(refiner.GetNumLevels());
        for (int i = 0; i < refiner.GetNumLevels(); ++i) {
            values.push_back(refiner.GetLevel(i).GetNumFVarValues(int(channels.size())));
        }
        channels.push_back({GetName(channel.kind), channel.width, values});
    }
    return channels;
}

namespace {

template <typename PROPERTY>
std::vector<PropertyStatistics> countProperties(std::vector<PROPERTY> const &properties) {
    std::vector<PropertyStatistics> result;
    for (PROPERTY const &property : properties) {
        result.push_back({property.name, GetName(property.type)});
    }
    return result;
}

/// Names that differ, in the order in which they come first.
class NameList {
public:
    explicit NameList(std::vector<std::string> *names) : _names(*names) {}

    void Add(std::string_view name) {
        if (!name.empty() && _known.emplace(name).second) {
            _names.emplace_back(name);
        }
    }

private:
    std::vector<std::string> &_names;
    std::set<std::string> _known;
};

} // namespace

AttributeStatistics CountAttributes(Mesh const &mesh) {
    AttributeStatistics attributes;
    attributes.vertexProperties = countProperties(mesh.vertexProperties);
    attributes.hasNormals = HasFloatNormals(mesh);
    attributes.faceProperties = countProperties(mesh.faceProperties);
    NameList objects(&attributes.objects);
    NameList groups(&attributes.groups);
    NameList materials(&attributes.materials);
    NameList smoothingGroups(&attributes.smoothingGroups);
    for (FaceLabel const &label : mesh.labels) {
        objects.Add(label.object);
        for (std::string_view group : SplitWords(label.groups)) {
            groups.Add(group);
        }
        materials.Add(label.material);
        smoothingGroups.Add(label.smoothing);
    }
    attributes.materialLibraries = mesh.materialLibraries;
    return attributes;
}

std::int64_t GetPeakMemoryBytes() {
#if defined(__unix__) || defined(__APPLE__)
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
    return usage.ru_maxrss;
#else
    return std::int64_t(usage.ru_maxrss) * 1024;
#endif
#else
    return 0;
#endif
}

namespace {

using Json = nlohmann::ordered_json;

Json makeJson(std::vector<PropertyStatistics> const &properties) {
    Json json = Json::array();
    for (PropertyStatistics const &property : properties) {
        json.push_back({{"name", property.name}, {"type", property.type}});
    }
    return json;
}

} // namespace

std::string FormatJson(Statistics const &statistics) {
    Json levels = Json::array();
    for (LevelStatistics const &level : statistics.levels) {
        Json facesBySize = Json::object();
        for (auto const &[size, numFaces] : level.facesBySize) {
            facesBySize[std::to_string(size)] = numFaces;
        }
        levels.push_back({{"level", levels.size()},
                          {"vertices", level.vertices},
                          {"edges", level.edges},
                          {"faces", level.faces},
                          {"corners", level.corners},
                          {"boundaryEdges", level.boundaryEdges},
                          {"facesBySize", facesBySize}});
    }
    Json channels = Json::array();
    for (ChannelStatistics const &channel : statistics.channels) {
        channels.push_back(
            {{"name", channel.name}, {"width", channel.width}, {"values", channel.values}});
    }
    Json coplanar;
    if (statistics.coplanar) {
        coplanar = {{"tolerance", statistics.coplanar->tolerance},
                    {"openGaps", statistics.coplanar->hasOpenGaps}};
    }
    Json adaptive;
    if (statistics.adaptive) {
        AdaptiveStatistics const &cells = *statistics.adaptive;
        adaptive = {{"facesByLevel", cells.facesByLevel},
                    {"faces", cells.faces},
                    {"points", cells.points},
                    {"culled", {{"outside", cells.outside}, {"backFacing", cells.backFacing}}},
                    {"types", cells.types},
                    {"hits", cells.hits},
                    {"bytes", cells.bytes},
                    {"channelValues", cells.channelValues},
                    {"maxLevel", cells.maxLevel},
                    {"facesOfMaxLevel", cells.facesOfMaxLevel}};
    }
    auto const &milliseconds = statistics.milliseconds;
    AttributeStatistics const &attributes = statistics.attributes;
    Json const json = {{"scheme", statistics.scheme},
                       {"mask", statistics.mask},
                       {"boundary", statistics.boundary},
                       {"evaluator", statistics.evaluator},
                       {"input", statistics.input},
                       {"levels", levels},
                       {"milliseconds",
                        {{"read", milliseconds.read},
                         {"validate", milliseconds.validate},
                         {"refine", milliseconds.refine},
                         {"stencils", milliseconds.stencils},
                         {"evaluate", milliseconds.evaluate},
                         {"write", milliseconds.write},
                         {"render", milliseconds.render}}},
                       {"stencils", statistics.stencils},
                       {"weights", statistics.weights},
                       {"peakMemoryBytes", GetPeakMemoryBytes()},
                       {"creasingMethod", statistics.creasingMethod},
                       {"creases", statistics.creases},
                       {"corners", statistics.corners},
                       {"holes", statistics.holes},
                       {"fvarInterpolation", statistics.fvarInterpolation},
                       {"fvarChannels", channels},
                       {"fvarChannelsLeftOut", statistics.channelsLeftOut},
                       {"firstStep", statistics.firstStep},
                       {"coplanar", coplanar},
                       {"adaptive", adaptive},
                       {"vertexProperties", makeJson(attributes.vertexProperties)},
                       {"faceProperties", makeJson(attributes.faceProperties)},
                       {"objects", attributes.objects},
                       {"groups", attributes.groups},
                       {"materials", attributes.materials},
                       {"smoothingGroups", attributes.smoothingGroups},
                       {"materialLibraries", attributes.materialLibraries},
                       {"notRead", statistics.notRead},
                       {"notWritten", statistics.notWritten}};
    // A path need not be UTF-8, JSON must be.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

template <typename... ARGS>
std::string format(char const *pattern, ARGS... args) {
    char line[256];
    std::snprintf(line, sizeof line, pattern, args...);
    return line;
}

std::string formatScheme(Statistics const &statistics) {
    std::string text = statistics.scheme;
    if (statistics.firstStep != "none") {
        text += " after " +
                std::string(statistics.firstStep == "truncate" ? "a truncation" : "a tri-hex step");
    }
    if (statistics.coplanar) {
        text += format(", coplanar within %g degrees", statistics.coplanar->tolerance);
        text += statistics.coplanar->hasOpenGaps ? ", gaps open" : "";
    }
    return text;
}

/// A line for each thing that there is.
std::string formatTags(Statistics const &statistics) {
    std::string lines;
    if (statistics.creases > 0 || statistics.corners > 0) {
        lines += format("%d creases (%s), %d corners\n", statistics.creases,
                        statistics.creasingMethod.c_str(), statistics.corners);
    }
    bool const hasHoles = !statistics.holes.empty() && statistics.holes[0] > 0;
    if (hasHoles && statistics.adaptive) {
        lines += format("%d %s no cells\n", statistics.holes[0],
                        statistics.holes[0] == 1 ? "hole, which has" : "holes, which have");
    } else if (hasHoles) {
        lines += format("%d %s the last level has %d faces\n", statistics.holes[0],
                        statistics.holes[0] == 1 ? "hole; without it" : "holes; without them",
                        statistics.levels.back().faces - statistics.holes.back());
    }
    for (std::size_t i = 0; i < statistics.channels.size(); ++i) {
        ChannelStatistics const &channel = statistics.channels[i];
        auto const &cells = statistics.adaptive;
        lines += format(
            "channel %s: %d values, %d in %s, linear interpolation %s\n", channel.name.c_str(),
            channel.values.front(), cells ? cells->channelValues[i] : channel.values.back(),
            cells ? "the cells" : "the last level", statistics.fvarInterpolation.c_str());
    }
    return lines;
}

std::string join(std::vector<std::string> const &names) {
    std::string text;
    for (std::string const &name : names) {
        text += (text.empty() ? "" : ", ") + EscapeControls(name);
    }
    return text;
}

std::string join(std::vector<PropertyStatistics> const &properties) {
    std::vector<std::string> names;
    for (PropertyStatistics const &property : properties) {
        names.push_back(property.type + " " + property.name);
    }
    return join(names);
}

/// "2 objects", or "1 object", unless there is none.
void addCount(char const *name, std::vector<std::string> const &items,
              std::vector<std::string> *counts) {
    if (!items.empty()) {
        counts->push_back(std::to_string(items.size()) + " " + name +
                          (items.size() > 1 ? "s" : ""));
    }
}

/// Returns a line for each kind of data: kept or dropped.
std::string formatAttributes(Statistics const &statistics) {
    AttributeStatistics const &attributes = statistics.attributes;
    std::string lines;
    auto const addLine = [&](std::string const &begin, std::string const &text) {
        lines += text.empty() ? "" : begin + text + "\n";
    };
    addLine("of vertices, interpolated linearly" +
                std::string(attributes.hasNormals ? ", normals then made 1 long: " : ": "),
            join(attributes.vertexProperties));
    addLine("of faces: ", join(attributes.faceProperties));
    std::vector<std::string> counts;
    addCount("object", attributes.objects, &counts);
    addCount("group", attributes.groups, &counts);
    addCount("material", attributes.materials, &counts);
    addCount("smoothing group", attributes.smoothingGroups, &counts);
    addLine("", join(counts));
    addLine("not read: ", join(statistics.notRead));
    addLine("not written, " + statistics.outputFormat + " files have no place for it: ",
            join(statistics.notWritten));
    return lines;
}

std::string formatAdaptive(AdaptiveStatistics const &cells) {
    std::string text =
        format("cells %11lld                         %7lld  by level",
               static_cast<long long>(cells.points), static_cast<long long>(cells.faces));
    for (std::size_t level = 0; level < cells.facesByLevel.size(); ++level) {
        text += format(" %d:%lld", int(level), static_cast<long long>(cells.facesByLevel[level]));
    }
    if (cells.facesOfMaxLevel > 0) {
        text += format(
            "\n%lld faces are of level %d, the last: they may be further than %g pixels from "
            "the surface, unless --max-level is higher",
            static_cast<long long>(cells.facesOfMaxLevel), cells.maxLevel,
            double(cells.pixelError));
    }
    text += format("\nculled: %lld cells outside of the picture, %lld facing away\n",
                   static_cast<long long>(cells.outside), static_cast<long long>(cells.backFacing));
    return text + format("%lld types of base faces, %lld hits, %lld bytes\n",
                         static_cast<long long>(cells.types), static_cast<long long>(cells.hits),
                         static_cast<long long>(cells.bytes));
}

} // namespace

std::string FormatSummary(Statistics const &statistics) {
    std::string summary = EscapeControls(statistics.input) + ": scheme " +
                          formatScheme(statistics) + ", mask " + statistics.mask + ", boundary " +
                          statistics.boundary + ", evaluator " + statistics.evaluator + "\n\n" +
                          "level    vertices       edges       faces    boundary  faces by size\n";
    for (std::size_t i = 0; i < statistics.levels.size(); ++i) {
        LevelStatistics const &level = statistics.levels[i];
        summary += format("%5d %11d %11d %11d %11d ", int(i), level.vertices, level.edges,
                          level.faces, level.boundaryEdges);
        for (auto const &[size, numFaces] : level.facesBySize) {
            summary += format(" %d:%d", size, numFaces);
        }
        summary += "\n";
    }
    if (statistics.adaptive) {
        summary += formatAdaptive(*statistics.adaptive);
    }
    summary += "\n" + formatTags(statistics) + formatAttributes(statistics);
    if (statistics.stencils > 0) {
        summary += format("%d stencils, %lld weights\n", statistics.stencils,
                          static_cast<long long>(statistics.weights));
    }
    auto const &ms = statistics.milliseconds;
    summary +=
        format("ms: read %.1f, validate %.1f, refine %.1f, stencils %.1f, evaluate %.1f, "
               "write %.1f, render %.1f\n",
               ms.read, ms.validate, ms.refine, ms.stencils, ms.evaluate, ms.write, ms.render);
    if (std::int64_t const bytes = GetPeakMemoryBytes()) {
        summary += format("peak memory %.1f MiB\n", double(bytes) / (1024 * 1024));
    }
    return summary;
}

} // namespace OpenSubdivHex::Tools
