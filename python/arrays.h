// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_PYTHON_ARRAYS_H
#define OPENSUBDIVHEX_PYTHON_ARRAYS_H

#include <opensubdiv/far/types.h>
#include <opensubdiv/osd/bufferDescriptor.h>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

/// Conversions between numpy and the library.  Arguments are checked here, before the library reads or
/// writes what they refer to.  Each check names the argument in its error.
namespace OpenSubdivHex::Python {

namespace py = pybind11;
namespace Far = OpenSubdiv::Far;
namespace Osd = OpenSubdiv::Osd;

/// @name Numbers that are read
/// An array may have any type of number, byte order and layout; a sequence becomes an array.  Numbers that the library
/// cannot read in place are copied, floating-point ones rounded to the type that is needed.  Raises TypeError for None,
/// for anything but numbers, and for anything but integers where these are needed.  Raises ValueError for masked numbers,
/// and for a number that the type does not hold, beyond its range or an integer that it would round; names its place.
/// @{

/// Takes integers, as 32-bit ones.  Raises ValueError for another number of dimensions.
py::array_t<int> TakeIndices(py::handle object, char const *name, int numDimensions = 1);

/// Takes numbers as floats, of one dimension, or one number for all \p count.
std::vector<float> TakeFloats(py::handle object, char const *name, std::size_t count);

/// The type for the numbers of elements: float64 for an array of that or longer ones; for all else, float32.
bool IsDouble(py::handle object);

/// \brief The elements that an evaluator reads or writes: rows of an array.
///
/// An array has one dimension, an element being one number, or two.  The numbers of an element lie
/// side by side; elements may be apart, as in a slice of the columns of another array.
template <typename REAL>
struct Elements {
    py::array array; ///< whose memory it is
    REAL *data = nullptr;
    int count = 0;
    Osd::BufferDescriptor desc; ///< offset 0
};

/// \brief Takes elements.
///
/// \param count    how many there must be; -1 for any number
/// \param isDense  whether they must lie without gaps
template <typename REAL>
Elements<REAL const> TakeSource(py::handle object, char const *name, int count,
                                bool isDense = false);
/// @}

/// \brief Takes an array of \p count elements to write, as long as those of \p source; makes one
/// for None.
///
/// It is written where it lies.  Raises TypeError where it is no array or has another type or byte order, and ValueError
/// where it is read-only or not aligned, or its elements lie otherwise than Elements says.
template <typename REAL>
Elements<REAL> TakeDestination(py::handle object, char const *name, int count,
                               Elements<REAL const> const &source);

/// Raises ValueError where the elements \p begin ... \p end - 1 of \p destination, which are about to
/// be written, show numbers of \p source.
template <typename REAL>
void CheckApart(Elements<REAL const> const &source, Elements<REAL> const &destination,
                char const *name, int begin, int end);

/// \brief An array that shows memory of \p owner, which lives as long as the array.  Nobody can
/// write to it.
template <typename T>
py::array View(T const *data, std::vector<py::ssize_t> shape, py::object const &owner);

/// An array that takes over the memory of a vector.
template <typename T>
py::array_t<T> TakeOver(std::vector<T> &&values) {
    auto *const vector = new std::vector<T>(std::move(values));
    py::capsule const owner(vector,
                            [](void *memory) { delete static_cast<std::vector<T> *>(memory); });
    return py::array_t<T>(py::ssize_t(vector->size()), vector->data(), owner);
}

/// Raises IndexError unless \p index is 0 ... \p size - 1.
void CheckIndex(long long index, int size, char const *name);

/// The shape of an array, as Python writes it.
std::string DescribeShape(py::array const &array);

} // namespace OpenSubdivHex::Python

#endif
