// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_GL_REFINEMENT_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_GL_REFINEMENT_EVALUATOR_H

#include "refinementEvaluator.h"

#include <memory>

namespace OpenSubdivHex::OsdExt {

/// \brief Names of buffers, or what Osd::GLVertexBuffer and the like bind.
struct GLBinding {
    using Source = unsigned; ///< control values
    using Buffer = unsigned; ///< what is written

    /// The name of a buffer.
    template <class BUFFER>
    static unsigned Bind(BUFFER &buffer) {
        return buffer.BindVBO();
    }
};

/// \brief Evaluates refined levels on a device by compute shaders of OpenGL 4.3, without a stencil
/// table: RefinementEvaluator for buffers of OpenGL.  Programs link OpenSubdivHex::osd_ext_gl, which
/// is built where CMake's OPENSUBDIVHEX_GL is on.
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
/// **Frames.** The functions are BufferEvaluator's, for names of buffers and for buffers whose function
/// BindVBO() returns them, such as Osd::GLVertexBuffer.  Places of elements are computed in 32 bits
/// without sign.  The first frame of a length compiles the programs that it needs, later ones those that
/// are missing.  They fail, too, with
///  - StatusCode::InvalidArgument if a buffer ends before its last element,
///  - StatusCode::Unsupported if the compiler takes no shader,
///  - StatusCode::TooLarge if the last element ends behind 2^31 bytes, or what the driver promises
///    beyond (GL_MAX_SHADER_STORAGE_BLOCK_SIZE), 2^32 floats at most.
///
/// **Memory.** Memory that the driver does not have throws std::bad_alloc.
class OPENSUBDIVHEX_API GLRefinementEvaluator
    : public DeviceRefinementEvaluator,
      public BufferEvaluator<GLRefinementEvaluator, GLBinding> {
public:
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
    /// Overload with default options.
    static std::unique_ptr<GLRefinementEvaluator> Create(FarExt::TopologyRefiner const &refiner,
                                                         FarExt::CallStatus *status = nullptr) {
        return Create(refiner, Options(), status);
    }

    /// \brief Writes the triangles of a level, three vertices each, unsigned integers of 32 bits.
    ///
    /// All faces are drawn whole: the triangles are those of CreateTriangleIndices() with cutBaseFaces false,
    /// CreaseCuts::NoCreases and drawHoles, in its order.  The device makes those of F-faces from the numbering, and those
    /// of other faces from their vertices, which the first call for a level loads from the refiner.
    ///
    /// Triangles of cut faces are CreateTriangleIndices()'s: where faces are cut depends on tags, seams and
    /// base faces, which no device has, and they change with the refinement alone, not with frames.
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

private:
    friend BufferEvaluator;
    GLRefinementEvaluator(std::unique_ptr<internal::Device> device,
                          FarExt::TopologyRefiner const &refiner);
};

} // namespace OpenSubdivHex::OsdExt

#endif
