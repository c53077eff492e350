// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_BORDER_EVALUATOR_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_BORDER_EVALUATOR_H

#include "gatheredPoints.h"
#include "placeSource.h"

#include <cstdint>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Evaluates what lies on the border of a base face, of which all faces that share it form the
/// same sums.
///
/// In a regular lattice edges and vertices have sums of their own points.  Where they are plain, long
/// edges and V-vertices have sums of rings.  Other edges have sums for the long edge that they become in
/// the first step, too: long edges have far fewer types than edges.  The long edge of half a polygon has sums of its own points.
template <typename REAL>
class BorderEvaluator {
public:
    /// Sets the face by its points, which must live as long as it is set.
    void SetFace(GatheredPoints<REAL> &points);
    /// The values of the rings of a plain face that is not in a lattice.
    RingValues<REAL> &GetRingValues() {
        if (!_hasValues) {
            setValues();
        }
        return _values;
    }

    /// Writes the point of a vertex.
    void EvaluateVertex(std::size_t vert, REAL *result);

    /// Writes the points inside of an edge that has a level, in the direction of the face.
    void EvaluateEdge(std::size_t edge, int level, REAL *results, std::ptrdiff_t stride);
    /// Writes the points at 1/rate, 2/rate ... inside of an edge, in the direction of the face.
    void EvaluateRate(std::size_t edge, int rate, REAL *results, std::ptrdiff_t stride);
    /// \brief Writes a point of a polyline, the stencil of which is kept as long as the type if the place is one of
    /// level kLastKeptLevel: deeper ones are many, and seldom come twice.
    ///
    /// \param place  what the start and the end of the edge weigh
    void EvaluateKeptPoint(std::size_t edge, Pair const &place, REAL *result);

    static constexpr int kLastKeptLevel = 8;
    static constexpr int kMaxKeptRate = 1024;

    /// Numbers of a point.
    std::size_t GetSize() const { return _points->GetSize(); }

private:
    // A matrix that was found.
    struct Found {
        PatternTable *patterns;
        PatternOf of;
        int number;
        PlaceMatrix<REAL> const *matrix;
    };

    template <typename MAKE>
    PlaceMatrix<REAL> const &find(PatternTable &patterns, PatternOf of, int number, Found &last,
                                  MAKE const &make);
    void evaluateInside(std::size_t edge, bool isRate, int level, REAL *results,
                        std::ptrdiff_t stride);
    CellType::BorderItem const &getItem(std::size_t item);
    void setValues();
    void evaluateVertex(std::size_t vert, REAL *result);
    void setEdge(std::size_t edge);

    CellType const *_type = nullptr;
    PlainFaceType const *_plain = nullptr;
    int const *_turns = nullptr;
    std::size_t _numEdges = 0;
    GatheredPoints<REAL> *_points = nullptr;
    std::size_t _paddedSize = 0;
    // For the last edge, if any.
    std::size_t _edgeNumber = 0;
    PlaceSource<REAL> _edge = {};
    bool _isReversed = false;
    // The number of the type of the last face, if it is not plain, and its items: mostly the next face is alike.
    struct KnownItem {
        int turn = -1;
        CellType::BorderItem const *item = nullptr;
    };
    std::uint64_t _typeNumber = 0;
    std::vector<KnownItem> _items;
    // The matrices of the edge and of the vertex that were last asked for: mostly others of the type are alike.
    Found _places = {};
    Found _vertex = {};
    PlaceMatrix<REAL> _placeMatrix; // that is not kept with the type
    std::vector<int> _indices;
    std::vector<REAL> _paddedPoints;
    std::vector<REAL> _stepPoints;
    std::vector<REAL> _longEdgePoints;
    bool _hasValues = false;
    RingValues<REAL> _values;     // of a plain face
    RingValues<REAL> _edgeValues; // of its own rings
    RingValues<REAL> _vertexValues;
};

extern template class BorderEvaluator<float>;
extern template class BorderEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

#endif
