// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_TABLE_SEARCH_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_TABLE_SEARCH_H

#include "localSubdivision.h"
#include "surfaceLevels.h"

#include "far_ext/hexSchemeOptions.h"
#include "far_ext/topologyRefiner.h"
#include "far_ext/vtr/level.h"

#include <opensubdiv/sdc/options.h>

#include <Eigen/Core>

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression {

/// Sides of the largest faces that have rows.
inline constexpr int kMaxMaskSize = 6;

/// \brief A row of a table of masks: the weights of an F-vertex, and its own weight in V'.
struct SearchRow {
    static constexpr double kNone = -1;

    int size = 0;             ///< of the mask; 0 where the row has none
    bool isSymmetric = false; ///< whether the mask and its mirror image are equal
    double ofVertex = kNone;  ///< kNone where the row does not tell it
    double weights[kMaxMaskSize] = {};
    double parts = 4096; ///< to which the library has them rounded

    /// Calls function(weight, place) for the weights that are free: those behind the first, which is what they leave
    /// to 1, and ofVertex, in place 0.  In a symmetric mask one of each two alike.
    template <typename FUNCTION>
    void ForEachFree(FUNCTION const &function) {
        int const end = isSymmetric ? size / 2 + 1 : size;
        for (int place = 1; place < end; ++place) {
            function(weights[place], place);
        }
        if (ofVertex != kNone) {
            function(ofVertex, 0);
        }
    }
};
using SearchRows = std::vector<SearchRow>;

/// \brief Where the weights of a corner stand in SearchRows.
struct CornerRow {
    static constexpr int kNone = -1;

    int ofFVertex = kNone; ///< the row with the mask
    int ofVertex =
        kNone; ///< the row with the F-vertex's weight in V', of which the vertex has the rest
    /// By weight of the mask, a place in the face.
    std::array<int, kMaxMaskSize> places = {};

    /// The places of all vertices of a face, from one of them on, forward or backward.
    void SetPlaces(int local, int size, bool isBackwards) {
        for (int i = 0; i < size; ++i) {
            places[std::size_t(i)] = (local + (isBackwards ? size - i : i)) % size;
        }
    }
    /// Those of half a hexagon, from a vertex inside the mesh on: of a half face, or of the half of a crossed face that
    /// the vertex is in.
    void SetPlacesInHalf(FarExt::internal::Level const &level, int face, int local,
                         bool isBackwards);
};

/// Leaves V' to rows only where all corners of a vertex have one.
void KeepWholeVertices(FarExt::internal::Level const &level, std::vector<CornerRow> &rows);

/// Columns that are computed at once: a position, or x, y, and the lifts of x and y.
inline constexpr int kNumMaskColumns = 5;
using MaskPoints = Eigen::Matrix<double, Eigen::Dynamic, kNumMaskColumns, Eigen::RowMajor>;

/// \brief A control mesh, refined once; its points follow any weights in the rows of a table.
class MaskedSurface {
public:
    /// Finds the rows of the corners of a level: one for each corner.
    using FindRows = std::function<std::vector<CornerRow>(FarExt::internal::Level const &)>;

    /// \param rows  those of the library: with them, points are where the library has them
    /// \throws std::runtime_error  where they are not, or if \p shape cannot be refined
    MaskedSurface(Shape const &shape, FarExt::HexSchemeOptions schemeOptions, int level,
                  SearchRows const &rows, FindRows const &findRows,
                  OpenSubdiv::Sdc::Options::VtxBoundaryInterpolation boundary =
                      OpenSubdiv::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);

    FarExt::TopologyRefiner const &GetRefiner() const { return *_refiner; }
    /// The last level, by the library's masks.
    PolygonMesh const &GetMesh() const { return _mesh; }
    /// The last level, by \p rows.
    PolygonMesh MakeMesh(SearchRows const &rows) const;

    /// Lets Refine() compute these vertices of the last level alone; or all, where there are none.
    void NeedOnly(std::vector<int> const &vertices);
    /// Points of the last level.
    MaskPoints Refine(SearchRows const &rows, MaskPoints points) const;
    /// How a vertex of the level behind \p depth is made.
    ChildRow GetRow(SearchRows const &rows, int depth, int cVertex) const;

    /// Whether a corner has a row.
    bool IsUsed(int row) const { return _isUsed[std::size_t(row)]; }
    /// The rows that tell V' of a vertex, one for each of its faces, sorted: each such list once, of vertices where all
    /// faces have one.
    std::vector<std::vector<int>> const &GetRowsOfVertices() const { return _rowsOfVertices; }

private:
    struct Source {
        bool isOfParent; // else an F-vertex
        int vertex;
        double weight;              // where no row has it
        int row = CornerRow::kNone; // which has it, in its mask at a place
        int place = kOfVertex;
    };
    static constexpr int kOfVertex = -1; // in place of a place: the weight in V'
    struct Made {
        std::vector<Source> sources;
        int parent = CornerRow::kNone; // which has what the sources leave to 1, if any
    };
    struct Step {
        int numParents;
        std::vector<Made> made;
        std::vector<char> needed;
    };

    static double getWeight(SearchRows const &rows, Source const &source);
    void addTruncation(int depth);
    void addStep(int depth, SearchRows const &rows, std::vector<CornerRow> const &ofCorners);

    FarExt::HexSchemeOptions const _schemeOptions;
    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    MaskPoints _controlPoints;
    PolygonMesh _mesh;
    std::vector<Step> _steps;
    std::vector<char> _isUsed; // by row
    std::vector<std::vector<int>> _rowsOfVertices;
};

/// \brief Second derivatives of lifted points at some vertices, in the plane of the points.
class PlaneDerivatives {
public:
    PlaneDerivatives() = default;
    PlaneDerivatives(PolygonMesh const &mesh, std::vector<int> const &vertices);

    /// The vertices whose points are used.
    std::vector<int> GetNeeded() const;
    /// By vertex: xx, xy and yy, each in a row; columns are lifts.
    std::vector<Eigen::Matrix3d> Compute(MaskPoints const &points) const;

    /// Points of \p shape as x, y and its lifts to a bowl, (x x + y y) / 2, and two saddles, (x x - y y) / 2 and x y.
    ///
    /// \param center  of the lifts, on the x axis
    static MaskPoints Lift(Shape const &shape, double center);
    /// The derivatives of these lifts.
    static Eigen::Matrix3d GetExact();

private:
    std::vector<int> _vertices;
    std::vector<std::vector<int>> _near;
};

/// Appends the mean, the difference and the mixed one of second derivatives, times \p factor, those of saddles also times
/// \p ofSaddle.
void AddDeviation(double factor, Eigen::Matrix3d const &deviation, double ofSaddle,
                  std::vector<double> &values);

/// \brief A search for the weights in a table of masks.
///
/// Weights are the free ones of the searched rows (SearchRow::ForEachFree), one row after the other.  What rows and V'
/// leave to 1 is kept from falling below 0.
class TableSearch {
public:
    virtual ~TableSearch();
    TableSearch(TableSearch const &) = delete;
    TableSearch &operator=(TableSearch const &) = delete;

    /// The weights that the library has.
    Eigen::VectorXd GetShipped() const { return gather(_shipped); }
    /// Where a search begins.
    Eigen::VectorXd GetStart() const { return gather(_start); }
    /// In the parts that the library keeps.
    Eigen::VectorXd Round(Eigen::VectorXd const &weights) const;

    /// What a search makes small.
    Eigen::VectorXd Measure(Eigen::VectorXd const &weights) const;

    /// How uneven a surface is.
    struct Entry {
        std::string name;
        double unevenness;
    };
    /// The norm of the first part of Measure(), and how uneven surfaces are that it does not look at.
    std::vector<Entry> Judge(Eigen::VectorXd const &weights) const;
    /// Prints the rows as the library has them.
    void Print(Eigen::VectorXd const &weights) const { print(spread(weights)); }

protected:
    /// \param rows  of the library
    explicit TableSearch(SearchRows const &rows) : _shipped(rows), _start(rows) {}

    SearchRows const &getShipped() const { return _shipped; }
    SearchRows const &getStart() const { return _start; }
    /// Rows that are not searched for are the library's in both.
    void search(std::vector<int> const &searched, SearchRows const &start);
    /// Keeps what V' leaves of 1, at vertices with such rows, from falling below 0.
    void keepRests(std::vector<std::vector<int>> const &rowsOfVertices) {
        _rowsOfVertices = rowsOfVertices;
    }

    /// By how much lifted points are uneven.
    virtual Eigen::VectorXd measureLifts(SearchRows const &rows) const = 0;
    /// Further conditions, of which there need not be any.
    virtual Eigen::VectorXd measureMore(SearchRows const &rows,
                                        Eigen::VectorXd const &weights) const = 0;
    virtual std::vector<Entry> judgeMore(SearchRows const &rows) const = 0;
    virtual void print(SearchRows const &rows) const = 0;

private:
    template <typename FUNCTION>
    void forEachFree(SearchRows &rows, FUNCTION const &function) const;
    Eigen::VectorXd gather(SearchRows rows) const;
    SearchRows spread(Eigen::VectorXd const &weights) const;
    Eigen::VectorXd measureRests(SearchRows const &rows) const;

    SearchRows _shipped;
    SearchRows _start;
    std::vector<int> _searched;
    std::vector<std::vector<int>> _rowsOfVertices;
};

/// The numbers in braces that begin or end a row in the library's tables: the weights, in its parts.
std::string FormatMask(SearchRow const &row);

} // namespace OpenSubdivHex::Regression

#endif
