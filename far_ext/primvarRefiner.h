// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PRIMVAR_REFINER_H
#define OPENSUBDIVHEX_FAR_EXT_PRIMVAR_REFINER_H

#include "topologyRefiner.h"

#include <memory>
#include <type_traits>
#include <vector>

namespace OpenSubdivHex::FarExt {

namespace internal {
class LimitRows;

/// The type that counts elements of a user's array: its \c size_type, as of std::vector, else Index.
template <class ARRAY, class = void>
struct ElementIndex {
    using Type = Far::Index;
};
template <class ARRAY>
struct ElementIndex<ARRAY, std::void_t<typename ARRAY::size_type>> {
    using Type = typename ARRAY::size_type;
};
template <class ARRAY>
decltype(auto) ElementOf(ARRAY &array, Far::Index i) {
    return array[typename ElementIndex<ARRAY>::Type(i)];
}

} // namespace internal

/// \cond  Not for users.
/// \brief The part of PrimvarRefinerReal that is the same for all types of weights: nothing for users.
class OPENSUBDIVHEX_API PrimvarRefinerBase {
protected:
    /// The kind of data.
    enum class Data { Vertex, Varying, FaceVarying };

    /// The weights that make the points of a level, some points at a time.
    class OPENSUBDIVHEX_API Rows {
    public:
        /// The sources of a point: first elements of the level before, then points of its own level,
        /// which earlier rows made.
        struct Row {
            Far::Index point;
            int numSources;
            int numPoints;
        };

        /// \param channel  face-varying channel, whose values are the points; -1: vertices are
        Rows(TopologyRefiner const &refiner, int level, Data data, int channel);
        ~Rows();

        Rows(Rows const &) = delete;
        Rows &operator=(Rows const &) = delete;

        /// Goes on to the next rows; false when there are none.
        bool Next();

        std::vector<Row> const &GetRows() const { return _rows; }
        /// The sources of all these rows, one after the other.
        Far::Index const *GetSources() const { return _sources.data(); }
        double const *GetWeights() const { return _weights.data(); }

    private:
        struct Reader;

        std::unique_ptr<Reader> _reader;
        std::vector<Row> _rows;
        std::vector<Far::Index> _sources;
        std::vector<double> _weights;
    };

    /// The weights that make the limit of the vertices of a refiner's last level.
    class OPENSUBDIVHEX_API LimitRows {
    public:
        /// The weights of vertices for the limit of one, and for its derivatives.
        struct Row {
            int size;
            Far::Index const *sources;
            double const *weights;
            double const *duWeights;
            double const *dvWeights;
        };

        explicit LimitRows(TopologyRefiner const &refiner);
        ~LimitRows();

        LimitRows(LimitRows const &) = delete;
        LimitRows &operator=(LimitRows const &) = delete;

        /// Finds the weights; false, with a status, where there are none.
        bool Find(CallStatus *status);
        Far::Index GetNumVertices() const;
        /// Valid until the next call.
        Row GetRow(Far::Index vert);

    private:
        TopologyRefiner const &_refiner;
        std::unique_ptr<internal::LimitRows> _rows;
        std::vector<Far::Index> _sources;
    };

    /// By face of \p level, the face of level - 1 that it has face-uniform data of.
    static std::vector<Far::Index> findUniformSources(TopologyRefiner const &refiner, int level);
};
/// \endcond

/// \brief Computes primvar data of one level from that of the level before, without tables.
///
/// The element types follow Far's protocol: \p src and \p dst are indexed by vertex (or face) and
/// their elements have `void Clear()` and `void AddWithWeight(Element const &, REAL)`.  An element
/// of \p dst must also take an element of \p dst, since V-vertices average new points.
/// \p REAL is the type of the weights.  Arguments are not checked.
///
/// Two meshes that share a sharp border line, with the same sharpness at its vertices, get the same
/// values on it, bit for bit, however either numbers and orients it, as long as AddWithWeight()
/// rounds the product before it adds (no fused multiply-add).
///
/// Levels and channels are not checked, as in Far, whose functions have no way to answer, either: those
/// that the refiner has not are undefined behaviour.
///
/// Works on the calling thread.  Several threads may use one primvar refiner at once, for elements
/// of their own.  What the elements throw passes through, and std::bad_alloc.
///
/// \code
///     PrimvarRefiner primvarRefiner(refiner);
///     for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
///         primvarRefiner.Interpolate(level, values[level - 1], values[level]);
///     }
/// \endcode
template <typename REAL>
class PrimvarRefinerReal : public PrimvarRefinerBase {
public:
    /// Keeps a reference to \p refiner.
    explicit PrimvarRefinerReal(TopologyRefiner const &refiner) : _refiner(refiner) {}

    /// The refiner that was given.
    TopologyRefiner const &GetTopologyRefiner() const { return _refiner; }

    /// \brief Vertex data: dst[v] for all vertices of \p level from src of level - 1 with the masks
    /// of the scheme.  1 <= level <= GetMaxLevel().
    template <class T, class U>
    void Interpolate(int level, T const &src, U &dst) const {
        interpolate(level, Data::Vertex, -1, src, dst);
    }

    /// \brief Varying data: linear, V' = V and P = (V + centroid)/2, for half faces the centroid of
    /// the whole hexagon; on a sharp boundary P = (3 V + W)/4.
    template <class T, class U>
    void InterpolateVarying(int level, T const &src, U &dst) const {
        interpolate(level, Data::Varying, -1, src, dst);
    }

    /// \brief Face-uniform data: dst[f] is a copy of the element of the face of level - 1 in which half 0
    /// of f lies.  Elements need operator= only.
    ///
    /// From data of level 0 on, dst[f] is the element of GetFaceBaseFace(f, 0) at every level, and
    /// dst[GetFaceBaseFace(f, half)] that of a half.  The face of level - 1 is GetFaceParentFace(f), except:
    ///  - half 0 of f lies in half 1 of a parent in two base faces (IsFaceBaseSplit): the face across
    ///    edge 1 of the parent, which lies in the right base face;
    ///  - behind other steps that face may count to another base face, since it lies across an edge of
    ///    level 0: the F-face of the base face, which has its index.
    template <class T, class U>
    void InterpolateFaceUniform(int level, T const &src, U &dst) const {
        std::vector<Far::Index> const sources = findUniformSources(_refiner, level);
        for (std::size_t cFace = 0; cFace < sources.size(); ++cFace) {
            internal::ElementOf(dst, Far::Index(cFace)) = internal::ElementOf(src, sources[cFace]);
        }
    }

    /// \brief Face-varying data: dst[i] for all GetNumFVarValues(channel) values of \p level from
    /// those of level - 1, by the channel's FVarLinearInterpolation.
    template <class T, class U>
    void InterpolateFaceVarying(int level, T const &src, U &dst, int channel = 0) const {
        interpolate(level, Data::FaceVarying, channel, src, dst);
    }

    /// \brief The limit of vertex data: dstPos[v] for all vertices of the last level from src, the
    /// values that Interpolate() made of it.
    ///
    /// \return  false, with nothing written, as LimitStencilTableFactory fails: InvalidArgument where
    ///          the last level has no full topology, Unsupported where it has no limit stencils
    template <class T, class U>
    bool Limit(T const &src, U &dstPos, CallStatus *status = nullptr) const {
        LimitRows rows(_refiner);
        if (!rows.Find(status)) {
            return false;
        }
        for (Far::Index vert = 0; vert < rows.GetNumVertices(); ++vert) {
            LimitRows::Row const row = rows.GetRow(vert);
            sum(src, row, row.weights, internal::ElementOf(dstPos, vert));
        }
        return true;
    }

    /// \brief Overload with the first derivatives of LimitStencilTableFactory, on side 0
    /// of each vertex (see LimitSides).
    template <class T, class U, class U1, class U2>
    bool Limit(T const &src, U &dstPos, U1 &dstTan1, U2 &dstTan2,
               CallStatus *status = nullptr) const {
        LimitRows rows(_refiner);
        if (!rows.Find(status)) {
            return false;
        }
        for (Far::Index vert = 0; vert < rows.GetNumVertices(); ++vert) {
            LimitRows::Row const row = rows.GetRow(vert);
            sum(src, row, row.weights, internal::ElementOf(dstPos, vert));
            sum(src, row, row.duWeights, internal::ElementOf(dstTan1, vert));
            sum(src, row, row.dvWeights, internal::ElementOf(dstTan2, vert));
        }
        return true;
    }

private:
    template <class T, class ELEMENT>
    static void sum(T const &src, LimitRows::Row const &row, double const *weights,
                    ELEMENT &&element) {
        element.Clear();
        for (int i = 0; i < row.size; ++i) {
            if (weights[i] != 0) {
                element.AddWithWeight(internal::ElementOf(src, row.sources[i]), REAL(weights[i]));
            }
        }
    }

    template <class T, class U>
    void interpolate(int level, Data data, int channel, T const &src, U &dst) const {
        Rows rows(_refiner, level, data, channel);
        while (rows.Next()) {
            Far::Index const *source = rows.GetSources();
            double const *weight = rows.GetWeights();
            for (Rows::Row const &row : rows.GetRows()) {
                auto &&point = internal::ElementOf(dst, row.point);
                point.Clear();
                for (int i = 0; i < row.numSources; ++i) {
                    point.AddWithWeight(internal::ElementOf(src, *source++), REAL(*weight++));
                }
                for (int i = 0; i < row.numPoints; ++i) {
                    point.AddWithWeight(internal::ElementOf(dst, *source++), REAL(*weight++));
                }
            }
        }
    }

    TopologyRefiner const &_refiner;
};

/// With weights in single precision.
using PrimvarRefiner = PrimvarRefinerReal<float>;

} // namespace OpenSubdivHex::FarExt

#endif
