// SPDX-License-Identifier: Apache-2.0
#include "glRefinementEvaluator.h"

#include "device/deviceRefinement.h"
#include "gl/refinementShader.h"
#include "refinement/evaluationChecks.h"

#include "far_ext/vtr/hierarchy.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>

namespace OpenSubdivHex::OsdExt {

using FarExt::Status;
using FarExt::StatusCode;
using FarExt::TopologyRefiner;
using FarExt::internal::FVarChannel;
using FarExt::internal::MeshLevels;
using FarExt::internal::Refinement;
using FarExt::internal::RefinementMask;
using internal::DeviceArrays;
using internal::DeviceFaceRun;
using internal::DeviceRefinement;
using internal::DeviceVertexRun;
using Osd::BufferDescriptor;

namespace {

constexpr int kMinVersion = 43;
// Groups of a dispatch in one dimension, which every driver takes.
constexpr std::uint32_t kMaxGroups = 65535;
// Places in a buffer are numbers of 32 bits in shaders.
constexpr std::int64_t kMaxPlaces = std::int64_t(1) << 32;

std::string str(std::int64_t number) { return std::to_string(number); }

Status failure(StatusCode code, std::string const &message) {
    return FarExt::internal::Failure(code, message);
}

Status tooMany() {
    return failure(StatusCode::TooLarge,
                   "the refinements have more indices or weights than 32 bits reach");
}

// A buffer of OpenGL, deleted with this.
class Buffer {
public:
    Buffer() = default;
    Buffer(Buffer const &) = delete;
    Buffer &operator=(Buffer const &) = delete;
    ~Buffer() {
        if (_name != 0) {
            glDeleteBuffers(1, &_name);
        }
    }

    GLuint GetName() const { return _name; }
    std::int64_t GetNumBytes() const { return _numBytes; }

    // Has a buffer of that size, or a larger one, whose content is not known.
    void Resize(std::int64_t numBytes) {
        if (_name != 0 && numBytes <= _numBytes) {
            return;
        }
        if (_name == 0) {
            glGenBuffers(1, &_name);
        }
        _numBytes = std::max<std::int64_t>(numBytes, sizeof(float)); // 0 would not be one
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, _name);
        glBufferData(GL_SHADER_STORAGE_BUFFER, GLsizeiptr(_numBytes), nullptr, GL_DYNAMIC_COPY);
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
    }
    template <typename ARRAY>
    void Write(std::int64_t firstByte, ARRAY const &array) const {
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, _name);
        glBufferSubData(GL_SHADER_STORAGE_BUFFER, GLintptr(firstByte),
                        GLsizeiptr(array.size() * sizeof(*array.data())), array.data());
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
    }

private:
    GLuint _name = 0;
    std::int64_t _numBytes = 0;
};

enum class Kernel { Copy, FaceRun, Corners, VertexRun, Vertices };

char const *getName(Kernel kernel) {
    switch (kernel) {
    case Kernel::Copy:
        return "COPY";
    case Kernel::FaceRun:
        return "FACE_RUN";
    case Kernel::Corners:
        return "CORNERS";
    case Kernel::VertexRun:
        return "VERTEX_RUN";
    default:
        return "VERTICES";
    }
}

// A program of OpenGL for a kernel, and the places of its uniforms; deleted with this.
class Program {
public:
    Program() = default;
    Program(Program const &) = delete;
    Program &operator=(Program const &) = delete;
    ~Program() { glDeleteProgram(_name); }

    Status Compile(Kernel kernel, int length, int faceSize) {
        std::string const definitions =
            "#version 430\n#define GROUP " + str(internal::kShaderGroup) + "\n#define LENGTH " +
            str(length) + "\n#define SIZE " + str(faceSize) + "\n#define " + getName(kernel) + "\n";
        char const *const sources[] = {definitions.c_str(), internal::kRefinementShader};
        GLuint const shader = glCreateShader(GL_COMPUTE_SHADER);
        glShaderSource(shader, 2, sources, nullptr);
        glCompileShader(shader);
        _name = glCreateProgram();
        glAttachShader(_name, shader);
        glLinkProgram(_name);
        glDeleteShader(shader);
        GLint isLinked = GL_FALSE;
        glGetProgramiv(_name, GL_LINK_STATUS, &isLinked);
        if (isLinked == GL_TRUE) {
            return Status();
        }
        constexpr int kMaxLog = 1000;
        char log[kMaxLog] = "";
        glGetProgramInfoLog(_name, kMaxLog, nullptr, log);
        return failure(StatusCode::Unsupported,
                       std::string("the compiler of OpenGL takes no shader ") + getName(kernel) +
                           " of length " + str(length) + ": " + log);
    }
    void Use() const { glUseProgram(_name); }
    void Set(char const *uniform, std::uint32_t value) const {
        glUniform1ui(getPlace(uniform), value);
    }
    void Set(char const *uniform, bool value) const { glUniform1i(getPlace(uniform), value); }
    void Set(char const *uniform, float value) const { glUniform1f(getPlace(uniform), value); }

private:
    // Compilers take out what a kernel does not use; setting place -1 does nothing.
    GLint getPlace(char const *uniform) const { return glGetUniformLocation(_name, uniform); }

    GLuint _name = 0;
};

// Floats of a buffer.
struct Elements {
    GLuint buffer;
    std::int64_t offset;
    int stride;
};

} // namespace

class GLRefinementEvaluator::Impl {
public:
    Status Prepare(TopologyRefiner const &refiner, Options options);

    Status Check(GLuint src, BufferDescriptor const &srcDesc, GLuint dst,
                 BufferDescriptor const &dstDesc, int level, std::int64_t numWritten) const;
    Status Compile(int length);
    void Evaluate(Elements const &src, Elements const &dst, int length, int level);
    void EvaluateAllLevels(Elements const &src, Elements const &dst, int length);

    int GetMaxLevel() const { return int(numElements.size()) - 1; }
    std::int64_t GetNumElementsAllLevels() const {
        return std::accumulate(numElements.begin() + 1, numElements.end(), std::int64_t(0));
    }
    std::int64_t GetNumDeviceBytes() const {
        return _indices.GetNumBytes() + _weights.GetNumBytes();
    }

    std::vector<int> numElements; // by level

private:
    // Where the listed corners and vertices of a refinement are among the indices.
    struct Places {
        std::uint32_t corners;
        std::uint32_t vertices;
    };

    Elements toVertices(Elements const &src, int length);
    void refine(std::size_t number, Elements const &src, Elements const &dst, int length);
    Program const &use(Kernel kernel, int length, int faceSize, Elements const &src,
                       Elements const &dst) const;
    static void dispatch(Program const &program, std::uint32_t count);

    using ProgramKey = std::pair<std::pair<Kernel, int>, int>; // with length and face size

    std::vector<DeviceRefinement> _refinements; // by level of the parent
    std::vector<Places> _places;
    std::vector<int> _faceSizes; // of runs
    Buffer _indices;
    Buffer _weights;
    // Of a face-varying channel some of whose values several vertices of its value mesh share: the
    // value of each is an index, from here on.
    int _numValueVertices = 0;
    std::uint32_t _firstValue = 0;
    std::map<ProgramKey, Program> _programs;
    Buffer _controlValues; // by vertex of that value mesh
    Buffer _scratch[2];    // levels below the one asked for
};

Status GLRefinementEvaluator::Impl::Prepare(TopologyRefiner const &refiner, Options options) {
    if (epoxy_gl_version() < kMinVersion || !epoxy_is_desktop_gl()) {
        return failure(StatusCode::Unsupported, "there is no current context of OpenGL 4.3");
    }
    bool const isFaceVarying = options.interpolationMode == FarExt::INTERPOLATE_FACE_VARYING;
    MeshLevels const &mesh =
        refiner.GetHierarchy().GetMesh(isFaceVarying ? options.fvarChannel : -1);
    std::vector<Refinement const *> refinements;
    std::vector<RefinementMask> masks;
    for (int level = 0; level <= refiner.GetMaxLevel(); ++level) {
        FarExt::internal::Level const &ofMesh = mesh.levels[std::size_t(level)];
        numElements.push_back(ofMesh.numVertices);
        if (level < refiner.GetMaxLevel()) {
            refinements.push_back(&mesh.refinements[std::size_t(level)]);
            masks.emplace_back(ofMesh, refiner.GetHexSchemeOptions(),
                               internal::GetInterpolation(refiner, options));
        }
    }
    DeviceArrays arrays;
    _refinements = internal::MakeDeviceRefinements(refinements, masks, arrays);
    if (_refinements.size() < refinements.size()) {
        return tooMany();
    }
    std::vector<std::int32_t> values;
    if (isFaceVarying) {
        FVarChannel const &channel =
            refiner.GetHierarchy().channels[std::size_t(options.fvarChannel)];
        numElements[0] = channel.numValues;
        if (channel.numValues != mesh.levels[0].numVertices) {
            _numValueVertices = mesh.levels[0].numVertices;
            values.assign(channel.valuesOfVertices.begin(), channel.valuesOfVertices.end());
        }
    }
    for (DeviceRefinement const &refinement : _refinements) {
        for (DeviceFaceRun const &run : refinement.faceRuns) {
            _faceSizes.push_back(run.size);
        }
    }
    std::sort(_faceSizes.begin(), _faceSizes.end());
    _faceSizes.erase(std::unique(_faceSizes.begin(), _faceSizes.end()), _faceSizes.end());

    auto next = std::int64_t(arrays.indices.size());
    auto const take = [&](std::size_t count) {
        auto const first = std::uint32_t(next);
        next += std::int64_t(count);
        return first;
    };
    constexpr std::size_t kCornerWords = sizeof(internal::DeviceCorner) / sizeof(std::int32_t);
    constexpr std::size_t kVertexWords = sizeof(internal::DeviceVertex) / sizeof(std::int32_t);
    for (DeviceRefinement const &refinement : _refinements) {
        std::uint32_t const corners = take(kCornerWords * refinement.corners.size());
        _places.push_back({corners, take(kVertexWords * refinement.vertices.size())});
    }
    _firstValue = take(values.size());
    if (next > kMaxPlaces) {
        return tooMany();
    }
    constexpr auto kWord = std::int64_t(sizeof(std::int32_t));
    _indices.Resize(next * kWord);
    _indices.Write(0, arrays.indices);
    for (std::size_t i = 0; i < _refinements.size(); ++i) {
        _indices.Write(_places[i].corners * kWord, _refinements[i].corners);
        _indices.Write(_places[i].vertices * kWord, _refinements[i].vertices);
    }
    _indices.Write(_firstValue * kWord, values);
    _weights.Resize(std::int64_t(arrays.weights.size()) * kWord);
    _weights.Write(0, arrays.weights);
    return Status();
}

Status GLRefinementEvaluator::Impl::Check(GLuint src, BufferDescriptor const &srcDesc, GLuint dst,
                                          BufferDescriptor const &dstDesc, int level,
                                          std::int64_t numWritten) const {
    Status status = internal::CheckLevel(level, GetMaxLevel());
    if (status.IsOk()) {
        status = internal::CheckDescriptors(srcDesc, dstDesc);
    }
    auto const check = [&](GLuint buffer, BufferDescriptor const &desc, std::int64_t count,
                           std::string const &what) {
        if (!status.IsOk() || count == 0) {
            return;
        }
        if (!glIsBuffer(buffer)) {
            status = failure(StatusCode::InvalidArgument,
                             "the " + what + " " + str(buffer) + " is no buffer");
            return;
        }
        GLint64 numBytes = 0;
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
        glGetBufferParameteri64v(GL_SHADER_STORAGE_BUFFER, GL_BUFFER_SIZE, &numBytes);
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
        std::int64_t const end = desc.offset + (count - 1) * desc.stride + desc.length;
        if (numBytes < end * std::int64_t(sizeof(float))) {
            status = failure(StatusCode::InvalidArgument,
                             "the " + what + " has " + str(numBytes) + " bytes, but the last of " +
                                 str(count) + " elements ends at byte " +
                                 str(end * std::int64_t(sizeof(float))));
        } else if (end > kMaxPlaces) {
            status = failure(StatusCode::TooLarge, "the last element of the " + what +
                                                       " ends at float " + str(end) +
                                                       ", beyond what 32 bits reach");
        }
    };
    check(src, srcDesc, numElements[0], "source");
    check(dst, dstDesc, numWritten, "destination");
    return status;
}

// All programs that a level may need.
Status GLRefinementEvaluator::Impl::Compile(int length) {
    auto const compile = [&](Kernel kernel, int faceSize) {
        auto const [program, isNew] = _programs.try_emplace({{kernel, length}, faceSize});
        Status status = isNew ? program->second.Compile(kernel, length, faceSize) : Status();
        if (!status.IsOk()) {
            _programs.erase(program);
        }
        return status;
    };
    Status status;
    for (Kernel const kernel :
         {Kernel::Copy, Kernel::Corners, Kernel::VertexRun, Kernel::Vertices}) {
        if (status.IsOk()) {
            status = compile(kernel, 0);
        }
    }
    for (int const faceSize : _faceSizes) {
        if (status.IsOk()) {
            status = compile(Kernel::FaceRun, faceSize);
        }
    }
    return status;
}

Program const &GLRefinementEvaluator::Impl::use(Kernel kernel, int length, int faceSize,
                                                Elements const &src, Elements const &dst) const {
    Program const &program = _programs.at({{kernel, length}, faceSize});
    program.Use();
    program.Set("sourceOffset", std::uint32_t(src.offset));
    program.Set("sourceStride", std::uint32_t(src.stride));
    program.Set("resultOffset", std::uint32_t(dst.offset));
    program.Set("resultStride", std::uint32_t(dst.stride));
    GLuint const buffers[] = {src.buffer, dst.buffer, _indices.GetName(), _weights.GetName()};
    for (GLuint binding = 0; binding < std::size(buffers); ++binding) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffers[binding]);
    }
    return program;
}

void GLRefinementEvaluator::Impl::dispatch(Program const &program, std::uint32_t count) {
    program.Set("count", count);
    std::uint32_t const numGroups =
        (count + internal::kShaderGroup - 1) / std::uint32_t(internal::kShaderGroup);
    std::uint32_t const numRows = (numGroups + kMaxGroups - 1) / kMaxGroups;
    if (numRows > 0) {
        glDispatchCompute((numGroups + numRows - 1) / numRows, numRows, 1);
    }
}

// The control values by vertex of the mesh of level 0.
Elements GLRefinementEvaluator::Impl::toVertices(Elements const &src, int length) {
    if (_numValueVertices == 0) {
        return src;
    }
    _controlValues.Resize(std::int64_t(_numValueVertices) * length * std::int64_t(sizeof(float)));
    Elements const result = {_controlValues.GetName(), 0, length};
    Program const &program = use(Kernel::Copy, length, 0, src, result);
    program.Set("areConsecutive", false);
    program.Set("firstIndex", _firstValue);
    dispatch(program, std::uint32_t(_numValueVertices));
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return result;
}

void GLRefinementEvaluator::Impl::refine(std::size_t number, Elements const &src,
                                         Elements const &dst, int length) {
    DeviceRefinement const &refinement = _refinements[number];
    auto const useWith = [&](Kernel kernel, int faceSize) -> Program const & {
        Program const &program = use(kernel, length, faceSize, src, dst);
        program.Set("firstFVertex", std::uint32_t(refinement.numVVertices));
        return program;
    };
    for (DeviceFaceRun const &run : refinement.faceRuns) {
        Program const &program = useWith(Kernel::FaceRun, run.size);
        program.Set("areConsecutive", run.areConsecutive);
        program.Set("firstIndex", run.first);
        program.Set("firstCorner", run.firstCorner);
        program.Set("firstWeight", run.firstWeight);
        dispatch(program, run.count);
    }
    if (!refinement.corners.empty()) {
        // Some corners are made again behind the runs that they are in.
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        Program const &program = useWith(Kernel::Corners, 0);
        program.Set("firstIndex", _places[number].corners);
        dispatch(program, std::uint32_t(refinement.corners.size()));
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    for (DeviceVertexRun const &run : refinement.vertexRuns) {
        Program const &program = useWith(Kernel::VertexRun, 0);
        program.Set("firstIndex", run.firstIndex);
        program.Set("firstVertex", run.firstVertex);
        program.Set("vertexWeight", refinement.vertexWeight);
        program.Set("averagesFaces", refinement.averagesFaces);
        dispatch(program, run.count);
    }
    if (!refinement.vertices.empty()) {
        Program const &program = useWith(Kernel::Vertices, 0);
        program.Set("firstIndex", _places[number].vertices);
        dispatch(program, std::uint32_t(refinement.vertices.size()));
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void GLRefinementEvaluator::Impl::Evaluate(Elements const &src, Elements const &dst, int length,
                                           int level) {
    if (level == 0) {
        Program const &program = use(Kernel::Copy, length, 0, src, dst);
        program.Set("areConsecutive", true);
        dispatch(program, std::uint32_t(numElements[0]));
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        return;
    }
    // The levels grow: the last two below the one asked for have room for those before.
    for (int below = std::max(1, level - 2); below < level; ++below) {
        _scratch[below % 2].Resize(std::int64_t(numElements[std::size_t(below)]) * length *
                                   std::int64_t(sizeof(float)));
    }
    Elements values = toVertices(src, length);
    for (int made = 1; made <= level; ++made) {
        Elements const next =
            made == level ? dst : Elements{_scratch[made % 2].GetName(), 0, length};
        refine(std::size_t(made) - 1, values, next, length);
        values = next;
    }
}

void GLRefinementEvaluator::Impl::EvaluateAllLevels(Elements const &src, Elements const &dst,
                                                    int length) {
    Elements values = toVertices(src, length);
    Elements next = dst;
    for (int made = 1; made <= GetMaxLevel(); ++made) {
        refine(std::size_t(made) - 1, values, next, length);
        values = next;
        next.offset += std::int64_t(numElements[std::size_t(made)]) * next.stride;
    }
}

namespace {

// Binds nothing, as if nothing had been.
void unbind() {
    glUseProgram(0);
    constexpr GLuint kNumBindings = 4;
    for (GLuint binding = 0; binding < kNumBindings; ++binding) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, 0);
    }
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

Elements getElements(GLuint buffer, BufferDescriptor const &desc) {
    return {buffer, desc.offset, desc.stride};
}

} // namespace

std::unique_ptr<GLRefinementEvaluator>
GLRefinementEvaluator::Create(TopologyRefiner const &refiner, Options options, Status *status) {
    Status result = internal::CheckOptions(refiner, options);
    std::unique_ptr<Impl> impl;
    if (result.IsOk()) {
        impl = std::make_unique<Impl>();
        result = impl->Prepare(refiner, options);
    }
    if (!FarExt::internal::Report(result, status)) {
        return nullptr;
    }
    return std::unique_ptr<GLRefinementEvaluator>(new GLRefinementEvaluator(std::move(impl)));
}

GLRefinementEvaluator::GLRefinementEvaluator(std::unique_ptr<Impl> impl) : _impl(std::move(impl)) {}

GLRefinementEvaluator::~GLRefinementEvaluator() = default;

int GLRefinementEvaluator::GetMaxLevel() const { return _impl->GetMaxLevel(); }

int GLRefinementEvaluator::GetNumElements(int level) const {
    return _impl->numElements[std::size_t(level)];
}

std::int64_t GLRefinementEvaluator::GetNumElementsAllLevels() const {
    return _impl->GetNumElementsAllLevels();
}

std::int64_t GLRefinementEvaluator::GetNumDeviceBytes() const { return _impl->GetNumDeviceBytes(); }

bool GLRefinementEvaluator::Evaluate(unsigned src, BufferDescriptor const &srcDesc, unsigned dst,
                                     BufferDescriptor const &dstDesc, int level, Status *status) {
    bool const isLevel = level >= 0 && level <= GetMaxLevel();
    std::int64_t const numWritten = isLevel ? GetNumElements(level) : 0;
    Status result = _impl->Check(src, srcDesc, dst, dstDesc, level, numWritten);
    if (result.IsOk()) {
        result = _impl->Compile(srcDesc.length);
    }
    if (result.IsOk() && numWritten > 0) {
        _impl->Evaluate(getElements(src, srcDesc), getElements(dst, dstDesc), srcDesc.length,
                        level);
    }
    unbind();
    return FarExt::internal::Report(result, status);
}

bool GLRefinementEvaluator::EvaluateAllLevels(unsigned src, BufferDescriptor const &srcDesc,
                                              unsigned dst, BufferDescriptor const &dstDesc,
                                              Status *status) {
    std::int64_t const numWritten = GetNumElementsAllLevels();
    Status result = _impl->Check(src, srcDesc, dst, dstDesc, GetMaxLevel(), numWritten);
    if (result.IsOk()) {
        result = _impl->Compile(srcDesc.length);
    }
    if (result.IsOk() && numWritten > 0) {
        _impl->EvaluateAllLevels(getElements(src, srcDesc), getElements(dst, dstDesc),
                                 srcDesc.length);
    }
    unbind();
    return FarExt::internal::Report(result, status);
}

} // namespace OpenSubdivHex::OsdExt
