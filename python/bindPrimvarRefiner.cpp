// SPDX-License-Identifier: Apache-2.0
//
// PrimvarRefiner: data of one level from those of the level before, without a table.
#include "arrays.h"
#include "refiner.h"

#include "far_ext/primvarRefiner.h"

#include <algorithm>
#include <functional>
#include <type_traits>

namespace OpenSubdivHex::Python {

namespace {

using namespace FarExt;

/// \brief An element of an array, as FarExt::PrimvarRefiner asks for.
template <typename REAL>
struct Element {
    void Clear() { std::fill_n(data, length, REAL(0)); }

    template <typename SOURCE>
    void AddWithWeight(Element<SOURCE> const &element, std::remove_const_t<REAL> weight) {
        for (int i = 0; i < length; ++i) {
            data[i] += weight * element.data[i];
        }
    }

    REAL *data;
    int length;
};

template <typename REAL>
struct ElementArray {
    explicit ElementArray(Elements<REAL> const &elements)
        : data(elements.data), stride(std::size_t(elements.desc.stride)),
          length(elements.desc.length) {}

    Element<REAL> operator[](Far::Index i) const {
        return {data + std::size_t(i) * stride, length};
    }

    REAL *data;
    std::size_t stride;
    int length;
};

class PrimvarRefinement {
public:
    explicit PrimvarRefinement(std::shared_ptr<Refiner> refiner) : _refiner(std::move(refiner)) {}

    py::object Interpolate(int level, py::object const &src, py::object const &dst) const {
        return interpolate(level, src, dst, &TopologyLevel::GetNumVertices,
                           [level](auto const &refiner, auto const &from, auto &to) {
                               refiner.Interpolate(level, from, to);
                           });
    }

    py::object InterpolateVarying(int level, py::object const &src, py::object const &dst) const {
        return interpolate(level, src, dst, &TopologyLevel::GetNumVertices,
                           [level](auto const &refiner, auto const &from, auto &to) {
                               refiner.InterpolateVarying(level, from, to);
                           });
    }

    py::object InterpolateFaceVarying(int level, py::object const &src, py::object const &dst,
                                      int channel) const {
        CheckIndex(channel, _refiner->Read([](auto &r) { return r.GetNumFVarChannels(); }),
                   "channel");
        return interpolate(
            level, src, dst,
            [channel](TopologyLevel const &topology) { return topology.GetNumFVarValues(channel); },
            [level, channel](auto const &refiner, auto const &from, auto &to) {
                refiner.InterpolateFaceVarying(level, from, to, channel);
            });
    }

    /// Elements of any type are copied, so that numpy can do it.
    py::object InterpolateFaceUniform(int level, py::object const &src,
                                      py::object const &dst) const {
        std::pair<int, int> const counts = countElements(level, &TopologyLevel::GetNumFaces);
        int const numSources = counts.first, numFaces = counts.second;
        py::module_ const numpy = py::module_::import("numpy");
        py::array const source = numpy.attr("asarray")(src);
        if (source.ndim() == 0 || source.shape(0) != numSources) {
            throw py::value_error("src: " + std::to_string(numSources) +
                                  " elements are needed, the shape is " + DescribeShape(source));
        }
        std::vector<int> parents(std::size_t(numFaces), 0);
        _refiner->Read([&](TopologyRefiner const &refiner) {
            checkUnchanged(refiner, level, &TopologyLevel::GetNumFaces, numSources, numFaces);
            std::vector<int> faces(std::size_t(numSources), 0);
            for (Far::Index f = 0; f < numSources; ++f) {
                faces[std::size_t(f)] = f;
            }
            PrimvarRefiner(refiner).InterpolateFaceUniform(level, faces, parents);
        });
        return numpy.attr("take")(source, TakeOver(std::move(parents)), py::arg("axis") = 0,
                                  py::arg("out") = dst);
    }

    py::object Limit(py::object const &src, py::object const &dst) const {
        return limit(src, {&dst}, {"dst"},
                     [](auto const &refiner, auto const &from, auto &to, CallStatus *status) {
                         refiner.Limit(from, to[0], status);
                     })[0];
    }

    py::tuple LimitWithDerivatives(py::object const &src, py::object const &dst,
                                   py::object const &du, py::object const &dv) const {
        return limit(src, {&dst, &du, &dv}, {"dst", "du", "dv"},
                     [](auto const &refiner, auto const &from, auto &to, CallStatus *status) {
                         refiner.Limit(from, to[0], to[1], to[2], status);
                     });
    }

private:
    /// Calls function(refiner, source, destinations, &status), and returns the destinations.
    template <typename LIMIT>
    py::tuple limit(py::object const &src, std::vector<py::object const *> const &given,
                    std::vector<char const *> const &names, LIMIT const &function) const {
        int const numVertices = _refiner->Read([](TopologyRefiner const &refiner) {
            return refiner.GetLevel(refiner.GetMaxLevel()).GetNumVertices();
        });
        auto const run = [&](auto real) {
            using REAL = decltype(real);
            Elements<REAL const> const source = TakeSource<REAL>(src, "src", numVertices);
            ElementArray<REAL const> const from(source);
            std::vector<ElementArray<REAL>> to;
            py::tuple arrays(given.size());
            for (std::size_t i = 0; i < given.size(); ++i) {
                Elements<REAL> const destination =
                    TakeDestination<REAL>(*given[i], names[i], numVertices, source);
                CheckApart(source, destination, names[i], 0, destination.count);
                to.emplace_back(destination);
                arrays[i] = destination.array;
            }
            CallStatus status;
            _refiner->Read([&](TopologyRefiner const &refiner) {
                if (refiner.GetLevel(refiner.GetMaxLevel()).GetNumVertices() != numVertices) {
                    throw std::runtime_error("the refiner refined in another thread");
                }
                function(PrimvarRefinerReal<REAL>(refiner), from, to, &status);
            });
            RaiseUnlessOk(status);
            return arrays;
        };
        if (IsDouble(src)) {
            return run(double());
        }
        return run(float());
    }

    template <typename COUNT>
    std::pair<int, int> countElements(int level, COUNT const &count) const {
        return _refiner->Read([&](TopologyRefiner const &refiner) {
            if (level < 1 || level > refiner.GetMaxLevel()) {
                throw py::index_error("level: " + std::to_string(level) + " is not one of 1 ... " +
                                      std::to_string(refiner.GetMaxLevel()));
            }
            return std::make_pair(std::invoke(count, refiner.GetLevel(level - 1)),
                                  std::invoke(count, refiner.GetLevel(level)));
        });
    }

    /// Another thread may have refined after the elements were counted.
    template <typename COUNT>
    static void checkUnchanged(TopologyRefiner const &refiner, int level, COUNT const &count,
                               int numSources, int numElements) {
        if (level > refiner.GetMaxLevel() ||
            std::invoke(count, refiner.GetLevel(level - 1)) != numSources ||
            std::invoke(count, refiner.GetLevel(level)) != numElements) {
            throw std::runtime_error("the refiner refined in another thread");
        }
    }

    template <typename COUNT, typename INTERPOLATE>
    py::object interpolate(int level, py::object const &src, py::object const &dst,
                           COUNT const &count, INTERPOLATE const &function) const {
        auto const [numSources, numElements] = countElements(level, count);
        auto const run = [&, numSources = numSources, numElements = numElements](auto real) {
            using REAL = decltype(real);
            Elements<REAL const> const source = TakeSource<REAL>(src, "src", numSources);
            Elements<REAL> const destination =
                TakeDestination<REAL>(dst, "dst", numElements, source);
            CheckApart(source, destination, "dst", 0, destination.count);
            ElementArray<REAL const> const from(source);
            ElementArray<REAL> to(destination);
            _refiner->Read([&](TopologyRefiner const &refiner) {
                checkUnchanged(refiner, level, count, numSources, numElements);
                function(PrimvarRefinerReal<REAL>(refiner), from, to);
            });
            return py::object(destination.array);
        };
        if (IsDouble(src)) {
            return run(double());
        }
        return run(float());
    }

    std::shared_ptr<Refiner> _refiner;
};

} // namespace

void BindPrimvarRefiner(py::module_ &module) {
    py::class_<PrimvarRefinement>(
        module, "PrimvarRefiner",
        "PrimvarRefiner(refiner)\n\n"
        "Computes the data of a level from the data of the level before, without a table, in "
        "float32 or\n"
        "float64.  RefinementEvaluator is parallel and faster, in float32.\n\n"
        "Sources have the shape (elements,) or (elements, length).  float64 stays; other numbers "
        "become\n"
        "float32.  A destination has the source's type and length; None allocates one.  Functions "
        "return\n"
        "the destination.")
        .def(py::init<std::shared_ptr<Refiner>>(), py::arg("refiner").none(false))
        .def("interpolate", &PrimvarRefinement::Interpolate,
             "interpolate(level, src, dst=None)\n\n"
             "Vertex data of a level, 1 ... max_level, from those of the level before: an element "
             "for\n"
             "each vertex.",
             py::arg("level"), py::arg("src"), py::arg("dst") = py::none())
        .def("interpolate_varying", &PrimvarRefinement::InterpolateVarying,
             "interpolate_varying(level, src, dst=None)\n\n"
             "Varying data of a level, interpolated linearly: an element for each vertex.",
             py::arg("level"), py::arg("src"), py::arg("dst") = py::none())
        .def("interpolate_face_uniform", &PrimvarRefinement::InterpolateFaceUniform,
             "interpolate_face_uniform(level, src, dst=None)\n\n"
             "Data by face, of any type, shape (faces, ...): each face takes the value of its "
             "parent face.",
             py::arg("level"), py::arg("src"), py::arg("dst") = py::none())
        .def("interpolate_face_varying", &PrimvarRefinement::InterpolateFaceVarying,
             "interpolate_face_varying(level, src, dst=None, channel=0)\n\n"
             "Face-varying data of a level: an element for each value of the channel.",
             py::arg("level"), py::arg("src"), py::arg("dst") = py::none(), py::arg("channel") = 0)
        .def("limit", &PrimvarRefinement::Limit,
             "limit(src, dst=None)\n\n"
             "Points of the limit surface at the vertices of the last level, from the data of this "
             "level.\n"
             "The level has full topology.  Raises StatusError.",
             py::arg("src"), py::arg("dst") = py::none())
        .def("limit_with_derivatives", &PrimvarRefinement::LimitWithDerivatives,
             "limit_with_derivatives(src, dst=None, du=None, dv=None)\n\n"
             "Points as limit(), and both first derivatives on side 0 of each vertex.\n\n"
             "Returns (dst, du, dv).",
             py::arg("src"), py::arg("dst") = py::none(), py::arg("du") = py::none(),
             py::arg("dv") = py::none());
}

} // namespace OpenSubdivHex::Python
