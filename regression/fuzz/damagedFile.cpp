// SPDX-License-Identifier: Apache-2.0
#include "damagedFile.h"

#include "byteSource.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <string_view>

namespace OpenSubdivHex::Regression {

namespace {

constexpr char kObj[] = "# a pyramid\n"
                        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 1e0 1\n"
                        "f 1 2 5\nf 2 3 5\nf -3 4 5\nf 4 1 5\nf 4 3 \\\n2 1\n";
constexpr char kObjWithChannels[] = "o quads\r\nv 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\n"
                                    "v 2 0 0\r\nv 2 1 .25\r\nvt 0 0\r\nvt 1 0\r\nvt 1 1 0\r\n"
                                    "vn 0 0 1\r\nvn 0 1 0\r\nusemtl m\r\n"
                                    "f 1/1/1 2/2/1 3/3/1 4/1/1\r\nf 2/2/1 5/2/2 6/3/2 3/3/1\r\n";
constexpr char kObjWithTags[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"
                                "vt 0 0\nvt 1 1\nf 1/1 2/2 3/1 4/2\nf 2/2 5/1 6/2 3/1\n"
                                "t crease 2/1/0 1 2 2.5\nt corner 1/1/0 0 3\nt hole 1/0/0 1\n"
                                "t interpolateboundary 1/0/0 1\nt creasemethod 0/0/1 chaikin\n"
                                "t facevaryinginterpolateboundary 1/0/0 2\n";
constexpr char kObjWithLabels[] =
    "mtllib two words.mtl b.mtl\no a cube # no comment\ng a b\ns off\nusemtl m#1\n"
    "v 0 0 0 1 0 .5\nv 1 0 0 0 .5 1\nv 1 1 0 1 1 1\nv 0 1 0 .25 0 0\nv .5 .5 1 2 0 0\n"
    "f 1 2 5\nusemtl n\\ \nf 2 3 5\ns 1\nf 3 4 5\nusemtl m#1\nl 1 2\nf 4 1 5\n"
    "t smoothtriangles 0/0/1 smooth\ng\nf 4 3 2 1\n";
constexpr char kObjWithWeights[] = "v 0 0 0 2\nv 1 0 0 .5\nv 1 1 0 1\nv 0 1 0\nvp 1\n"
                                   "f 1 2 3\ng x\nf 1 3 4\n";
constexpr char kOff[] = "OFF\n5 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n.5 .5 1\n"
                        "4 0 1 2 3\n3 0 1 4 255 0 0\n3 1 2 4\n";
constexpr char kColoredOff[] = "CNOFF 3 1 3 # counts\n0 0 0 0 0 1 1 0 0 1\n1 0 0 0 0 1 1 0 0 1\n"
                               "1 1 0 0 0 1 1 0 0 1\n\n3 0 1 2";
constexpr char kFloatOff[] = "STCOFF\n3 2 0\n0 0 0 .5 1 1 1 0 1.0\n1 0 0 1 1 1 1 1 0\n"
                             "1 1 0 0 0 0 1.0 .5 .5\n3 0 1 2 .5 1 0\n3 2 1 0 1 1 1\n";
constexpr char kTextPlyWithLists[] =
    "ply\nformat ascii 1.0\nelement face 2\nproperty uchar red\n"
    "property list uchar int vertex_indices\nproperty list uchar float texcoord\n"
    "property double id\nelement vertex 4\nproperty int x\nproperty short y\n"
    "property list uchar ushort more\nproperty uchar z\nproperty uchar red\n"
    "property uchar green\nproperty uchar blue\nproperty float nx\nproperty uint label\n"
    "end_header\n7 3 0 1 2 2 .5 1 1e100\n255 3 0 2 3 0 -2\n"
    "0 0 0 0 255 0 128 1 4294967295\n1 0 2 7 8 0 1 2 3 .5 16777217\n1 1 0 0 9 9 9 -1 3\n"
    "0 1 0 0 0 0 0 0 1\n";
constexpr char kTextPly[] = "ply\nformat ascii 1.0\ncomment a pyramid\nelement vertex 5\n"
                            "property float x\nproperty float y\nproperty float z\n"
                            "property uchar red\nelement face 3\n"
                            "property list uchar int vertex_indices\nproperty int flags\n"
                            "element edge 1\nproperty int vertex1\nend_header\n"
                            "0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 0 4\n.5 .5 1 5\n"
                            "4 0 1 2 3 7\n3 0 1 4 7\n3 1 2 4 7\n0\n";

/// A triangle in binary; the numbers are 0 and 1 in either order of bytes.
std::string makeBinaryPly(bool isLittleEndian, bool isDouble) {
    auto const put = [&](std::string *out, std::string bytes) {
        if (!isLittleEndian) {
            std::reverse(bytes.begin(), bytes.end());
        }
        *out += bytes;
    };
    std::string const type = isDouble ? "double" : "float";
    std::string out = std::string("ply\nformat binary_") + (isLittleEndian ? "little" : "big") +
                      "_endian 1.0\nelement vertex 3\nproperty " + type + " x\nproperty " + type +
                      " y\nproperty " + type +
                      " z\nproperty uchar red\nproperty list uchar short more\n"
                      "element face 1\nproperty list " +
                      (isDouble ? "uint" : "uchar") +
                      " int vertex_indices\nproperty ushort flags\nend_header\n";
    std::string const zero(isDouble ? 8 : 4, '\0');
    std::string one = zero;
    one.replace(one.size() - 2, 2, isDouble ? "\xf0\x3f" : "\x80\x3f");
    auto const putInt = [&](int value, std::size_t size) {
        std::string bytes(size, '\0');
        bytes[0] = char(value);
        put(&out, bytes);
    };
    for (int vertex = 0; vertex < 3; ++vertex) {
        for (int axis = 0; axis < 3; ++axis) {
            put(&out, axis == vertex ? one : zero);
        }
        putInt(100 * vertex, 1);
        putInt(vertex, 1);
        for (int i = 0; i < vertex; ++i) {
            putInt(i, 2);
        }
    }
    putInt(3, isDouble ? 4 : 1);
    for (int vertex : {0, 1, 2}) {
        putInt(vertex, 4);
    }
    putInt(9, 2);
    return out;
}

DamagedFile makeFile(int choice) {
    struct Text {
        char const *name;
        char const *content;
    };
    constexpr Text kTexts[] = {{"a.obj", kObj},           {"a.obj", kObjWithChannels},
                               {"a.obj", kObjWithTags},   {"a.off", kOff},
                               {"a.off", kColoredOff},    {"a.ply", kTextPly},
                               {"a.obj", kObjWithLabels}, {"a.obj", kObjWithWeights},
                               {"a.off", kFloatOff},      {"a.ply", kTextPlyWithLists}};
    if (choice < int(std::size(kTexts))) {
        return {kTexts[choice].name, kTexts[choice].content};
    }
    return {"a.ply", makeBinaryPly(choice % 2 == 0, choice / 2 % 2 == 0)};
}
constexpr int kNumFiles = 14;

using namespace std::string_view_literals;
constexpr std::string_view kWords[] = {"0"sv,
                                       "1"sv,
                                       "-1"sv,
                                       "3"sv,
                                       "4"sv,
                                       "+1"sv,
                                       "-0"sv,
                                       "255"sv,
                                       "256"sv,
                                       "65536"sv,
                                       "2147483647"sv,
                                       "-2147483648"sv,
                                       "4294967296"sv,
                                       "99999999999999999999"sv,
                                       "1e39"sv,
                                       "3.4028235e38"sv,
                                       "-3.4028235e38"sv,
                                       "1e-45"sv,
                                       "1e-60"sv,
                                       "1e999"sv,
                                       "nan"sv,
                                       "inf"sv,
                                       "0x1p3"sv,
                                       "1.5.5"sv,
                                       "1e"sv,
                                       "."sv,
                                       "-"sv,
                                       "/"sv,
                                       "//"sv,
                                       "1/1"sv,
                                       "1//1"sv,
                                       "1/1/1"sv,
                                       "-1/-1/-1"sv,
                                       "\n"sv,
                                       "\r"sv,
                                       "\\\n"sv,
                                       "#"sv,
                                       " "sv,
                                       "\t"sv,
                                       "\f"sv,
                                       "\0"sv,
                                       "\x1b"sv,
                                       "\xff"sv,
                                       "\nf 1 2 3\n"sv,
                                       "\nv 0 0 1\n"sv,
                                       "\nvt 1\n"sv,
                                       "\nvn 1 0 0\n"sv,
                                       "\nl 1 2\n"sv,
                                       "\nt hole 1/0/0 0\n"sv,
                                       "\nt crease 2/1/0 0 1 1\n"sv,
                                       "\nt corner 1/1/0 2 10\n"sv,
                                       "\nt crease 3/2/0 0 1 2 1 2\n"sv,
                                       "\nt smooth 0/0/0\n"sv,
                                       "\nt smoothtriangles 0/0/0\n"sv,
                                       "\nusemtl #\\\\"sv,
                                       "\no\n"sv,
                                       "\ng a\n"sv,
                                       "\ns 1\n"sv,
                                       "\nmtllib \\\\ \n"sv,
                                       "\nv 0 0 1 .5 1 0\n"sv,
                                       "1 1 1\n"sv,
                                       "OFF"sv,
                                       "STCNOFF"sv,
                                       "ply"sv,
                                       "end_header\n"sv,
                                       "element vertex 3\n"sv,
                                       "element face 0\n"sv,
                                       "element face 2\n"sv,
                                       "property float x\n"sv,
                                       "property list uchar int vertex_indices\n"sv,
                                       "property list int uint vertex_index\n"sv,
                                       "property short s\n"sv,
                                       "property uchar green\nproperty uchar blue\n"sv,
                                       "property list char double l\n"sv,
                                       "property float ny\nproperty float nz\n"sv,
                                       "format ascii 1.0\n"sv,
                                       "format binary_big_endian 1.0\n"sv,
                                       "comment\n"sv,
                                       "uchar"sv,
                                       "char"sv,
                                       "ushort"sv,
                                       "double"sv};

/// Two bytes say where.
std::size_t chooseUpTo(ByteSource &bytes, std::size_t max) {
    std::size_t const high = std::size_t(bytes.GetByte());
    return (high * 256 + std::size_t(bytes.GetByte())) % (max + 1);
}

/// The word around a place, or the spaces.
std::pair<std::size_t, std::size_t> findWord(std::string const &text, std::size_t place) {
    auto const isSpace = [&](std::size_t i) { return std::strchr(" \t\r\n", text[i]) != nullptr; };
    std::size_t begin = place;
    std::size_t end = place;
    while (begin > 0 && isSpace(begin - 1) == isSpace(place)) {
        --begin;
    }
    while (end < text.size() && isSpace(end) == isSpace(place)) {
        ++end;
    }
    return {begin, end - begin};
}

void damage(ByteSource &bytes, std::string *text) {
    enum { kReplaceWord, kPutIn, kReplaceByte, kFlipBit, kLeaveOut, kRepeat, kMove, kCut, kCount };
    int const action = bytes.Choose(kCount);
    if (text->empty() || action == kPutIn) {
        std::string_view const word = kWords[bytes.Choose(int(std::size(kWords)))];
        text->insert(chooseUpTo(bytes, text->size()), word);
        return;
    }
    std::size_t const place = chooseUpTo(bytes, text->size() - 1);
    auto const [begin, length] = findWord(*text, place);
    std::string const word = text->substr(begin, length);
    switch (action) {
    case kReplaceWord:
        text->replace(begin, length, kWords[bytes.Choose(int(std::size(kWords)))]);
        break;
    case kReplaceByte:
        (*text)[place] = char(bytes.GetByte());
        break;
    case kFlipBit:
        (*text)[place] = char((*text)[place] ^ (1 << bytes.Choose(8)));
        break;
    case kLeaveOut:
        text->erase(begin, length);
        break;
    case kRepeat:
        text->insert(begin, text->substr(begin, chooseUpTo(bytes, 40)));
        break;
    case kMove:
        text->erase(begin, length);
        text->insert(chooseUpTo(bytes, text->size()), word);
        break;
    default:
        // The end is cut off seldom, since most files say how long they are.
        text->resize(bytes.IsOneOf(4) ? place : text->size());
        break;
    }
}

} // namespace

DamagedFile MakeDamagedFile(std::uint8_t const *data, std::size_t size) {
    constexpr int kAsItIs = 250;
    constexpr char const *kNames[] = {"a.obj", "a.off", "a.ply"};
    if (size > 0 && data[0] >= kAsItIs) {
        return {kNames[data[0] % 3], std::string(data + 1, data + size)};
    }
    ByteSource bytes(data, size);
    DamagedFile file = makeFile(bytes.Choose(kNumFiles));
    int const numActions = bytes.Choose(bytes.IsOneOf(4) ? 32 : 4);
    for (int i = 0; i < numActions && !bytes.IsAtEnd(); ++i) {
        damage(bytes, &file.content);
    }
    return file;
}

} // namespace OpenSubdivHex::Regression
