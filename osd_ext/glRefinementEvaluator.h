// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_GL_REFINEMENT_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_GL_REFINEMENT_EVALUATOR_H

#include "refinementEvaluator.h"

#include "far_ext/export.h"
#include "far_ext/status.h"
#include "far_ext/topologyRefiner.h"

#include <opensubdiv/osd/bufferDescriptor.h>

#include <cstdint>
#include <memory>

namespace OpenSubdivHex::OsdExt {

namespace internal {
class DeviceEvaluator;
}

/// \brief What Osd::GLVertexBuffer and the like bind.
struct GLBinding {
    /// The name of the buffer.
    template <class BUFFER>
    static auto Bind(BUFFER &buffer) -> decltype(unsigned(buffer.BindVBO())) {
        return buffer.BindVBO();
    }
};

/// \brief Evaluates refined levels on a device by compute shaders of OpenGL 4.3, without a stencil
/// table: RefinementEvaluator for buffers of OpenGL.  Programs link OpenSubdivHex::osd_ext_gl, which
/// is built where CMake's OPENSUBDIVHEX_GL is on.
///
/// Control values are refined level by level.  Of the topology, the device has about 8 bytes for
/// each vertex of the last level, where a stencil table has about 200; all else follows from the
/// numbering (far_ext/INDEXING.md).
///
/// \code
///     auto const evaluator = OsdExt::GLRefinementEvaluator::Create(*refiner);
///     Osd::BufferDescriptor const desc(0, 3, 3);
///     for each frame:
///         evaluator->Evaluate(controlPositions, desc, positions, desc, evaluator->GetMaxLevel());
/// \endcode
///
/// **Context.** A context of OpenGL 4.3 or later must be current in all functions, always the same or
/// one that shares its objects.  Afterwards no program is current, and nothing is bound to
/// GL_SHADER_STORAGE_BUFFER and its first eight indices.  Who reads the result
/// by other means than shader storage buffers calls glMemoryBarrier() before, as behind
/// Osd::GLComputeEvaluator.
///
/// **Elements.** Element j of a buffer is the \c length floats from <tt>offset + j * stride</tt>
/// on, computed in 32 bits without sign.  Nothing else is written.  Source and destination may be
/// one buffer, as long as no float is both read and written.
///
/// **Buffers.** In place of names, all functions take buffers whose function BindVBO() returns them,
/// such as Osd::GLVertexBuffer: see BufferEvaluator.
///
/// **Results.** The sums of RefinementEvaluator, for nearly all vertices in the same order, each
/// product and sum rounded by itself: on every device the same bits.  Values whose sums are too large
/// for a float are not scaled as there.
///
/// **Threads.** An evaluator keeps the levels below the one that was asked for: it is used by one thread at
/// a time, that of the context.
///
/// **Memory.** Memory that the driver does not have throws std::bad_alloc.
///
/// **Lifetime.** The evaluator keeps what it needs of the refiner, but for the limits: the first frame
/// of the limit of a level needs the refiner as it was.
class OPENSUBDIVHEX_API GLRefinementEvaluator
    : public BufferEvaluator<GLRefinementEvaluator, GLBinding> {
public:
    /// What is evaluated.
    using Options = RefinementEvaluator::Options;

    /// \brief Prepares for the levels that \p refiner has, and loads what the device needs.
    ///
    /// \return  null with
    ///           - StatusCode::InvalidArgument for a channel that is not there, or an
    ///             interpolationMode that is none,
    ///           - StatusCode::Unsupported without a context of OpenGL 4.3, or if its compiler takes
    ///             no shader,
    ///           - StatusCode::TooLarge if there are more than 2^32 indices, or more bytes of them than the
    ///             driver reaches
    static std::unique_ptr<GLRefinementEvaluator> Create(FarExt::TopologyRefiner const &refiner,
                                                         Options options,
                                                         FarExt::CallStatus *status = nullptr);
    /// The same with the default options.
    static std::unique_ptr<GLRefinementEvaluator> Create(FarExt::TopologyRefiner const &refiner,
                                                         FarExt::CallStatus *status = nullptr) {
        return Create(refiner, Options(), status);
    }

    /// Deletes its objects of OpenGL.
    ~GLRefinementEvaluator();

    /// The last level that can be evaluated, that of the refiner when this was made.
    int GetMaxLevel() const;
    /// Elements of a level: its vertices or face-varying values.  Those of level 0 are the source.
    int GetNumElements(int level) const;
    /// Elements of levels 1 ... GetMaxLevel() together.
    std::int64_t GetNumElementsAllLevels() const;
    /// Bytes that lie on the device, but for the levels below the one that was asked for.
    std::int64_t GetNumDeviceBytes() const;

    using BufferEvaluator::Evaluate;
    using BufferEvaluator::EvaluateAllLevels;
    using BufferEvaluator::EvaluateLimit;

    /// \brief Writes the values of one level to elements [0, GetNumElements(level)) of \p dst.
    ///
    /// The first frame of a length compiles the programs that it needs, later ones those that are missing;
    /// the levels below are kept in buffers that only the first frame takes.
    ///
    /// \param src,dst  names of buffers
    /// \param level    0 ... GetMaxLevel(); 0 copies the control values
    ///
    /// \return  false, with nothing written, with
    ///           - StatusCode::InvalidArgument if \p level is out of range, the lengths of the
    ///             descriptors differ or are less than 1, a stride is less than the length, an
    ///             offset is negative, or a buffer is 0 or ends before its last element,
    ///           - StatusCode::Unsupported if the compiler takes no shader,
    ///           - StatusCode::TooLarge if the last element ends behind 2^31 bytes, or what the driver
    ///             promises beyond (GL_MAX_SHADER_STORAGE_BLOCK_SIZE), 2^32 floats at most
    bool Evaluate(unsigned src, Osd::BufferDescriptor const &srcDesc, unsigned dst,
                  Osd::BufferDescriptor const &dstDesc, int level,
                  FarExt::CallStatus *status = nullptr);

    /// \brief Writes the values of levels 1 ... GetMaxLevel() to elements
    /// [0, GetNumElementsAllLevels()), level behind level: the order of a stencil table with
    /// intermediate levels.  Fails as Evaluate does.
    bool EvaluateAllLevels(unsigned src, Osd::BufferDescriptor const &srcDesc, unsigned dst,
                           Osd::BufferDescriptor const &dstDesc,
                           FarExt::CallStatus *status = nullptr);

    /// @name The limit surface
    /// Of the vertices of a level, as RefinementEvaluator::EvaluateLimit: points, and first derivatives
    /// on side 0, whose cross product is the normal.
    ///
    /// In faces of level 0 around which that is a regular lattice of triangles, quads or hexagons, all
    /// vertices come from level 0 in closed form, of which the device has 4 to 5 bytes for each of them.
    /// Elsewhere six vertices at a time come from a hexagon of a level before, with 5 bytes for each; those
    /// near irregular vertices and faces of level 0 and near features are sums over their neighbourhoods,
    /// which are listed.  The first frame of a level
    /// finds the masks on the processor, and refers to the refiner that was given.
    ///
    /// \param src          the name of a buffer of control values
    /// \param dst,du,dv    names of buffers, for elements [0, GetNumElements(level)) each
    /// \param srcDesc,dstDesc,duDesc,dvDesc  of the same length
    /// \param level        0 ... GetMaxLevel(), with full topology
    /// \param status       says what was wrong; may be null
    ///
    /// \return  false, with nothing written, as Evaluate; besides with InvalidArgument for other
    ///          modes than INTERPOLATE_VERTEX or if the refiner refined or unrefined in the meantime,
    ///          and as FarExt::LimitStencilTableFactory fails
    /// @{

    /// The points alone.
    bool EvaluateLimit(unsigned src, Osd::BufferDescriptor const &srcDesc, unsigned dst,
                       Osd::BufferDescriptor const &dstDesc, int level,
                       FarExt::CallStatus *status = nullptr);
    /// The points and their derivatives.
    bool EvaluateLimit(unsigned src, Osd::BufferDescriptor const &srcDesc, unsigned dst,
                       Osd::BufferDescriptor const &dstDesc, unsigned du,
                       Osd::BufferDescriptor const &duDesc, unsigned dv,
                       Osd::BufferDescriptor const &dvDesc, int level,
                       FarExt::CallStatus *status = nullptr);
    /// @}

    /// @name Triangles
    /// Of a level whose faces are all drawn whole: those of CreateTriangleIndices() with cutBaseFaces
    /// false, CreaseCuts::NoCreases and drawHoles, in its order.  They are made on the device, those of
    /// F-faces from the numbering alone, those of other faces from their vertices, which the first call
    /// for a level loads; it refers to the refiner that was given.
    /// Triangles of cut faces are CreateTriangleIndices()'s: where faces are cut depends on tags, seams and
    /// base faces, which no device has, and they change with the refinement alone, not with frames.
    /// @{

    /// How many a level has.
    std::int64_t GetNumTriangles(int level) const;
    /// \brief Writes three vertices for each, unsigned integers of 32 bits.
    ///
    /// \param dst           the name of a buffer
    /// \param level         0 ... GetMaxLevel()
    /// \param vertexOffset  added to every vertex; not negative
    /// \param status        says what was wrong; may be null
    ///
    /// \return  false, with nothing written, with InvalidArgument for a level or a buffer as in
    ///          Evaluate(), a negative offset, for INTERPOLATE_FACE_VARYING, or if the refiner refined or
    ///          unrefined in the meantime; and else as Evaluate
    bool MakeTriangleIndices(unsigned dst, int level, int vertexOffset = 0,
                             FarExt::CallStatus *status = nullptr);
    /// @}

private:
    explicit GLRefinementEvaluator(std::unique_ptr<internal::DeviceEvaluator> evaluator);

    std::unique_ptr<internal::DeviceEvaluator> _evaluator;
};

} // namespace OpenSubdivHex::OsdExt

#endif
