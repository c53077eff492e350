// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <cstdint>
#include <limits>
#include <type_traits>

namespace OpenSubdivHex::Python {

namespace {

std::string nameType(py::handle object) {
    return py::isinstance<py::array>(object)
               ? std::string(py::str(object.attr("dtype")))
               : std::string(py::str(py::type::handle_of(object).attr("__name__")));
}

/// What numpy makes of an object.  Its own errors, as of rows that differ in length, stay.
py::array toArray(py::handle object, char const *name) {
    if (object.is_none()) {
        throw py::type_error(std::string(name) + ": an array is needed, not None");
    }
    py::array array = py::module_::import("numpy").attr("asarray")(object);
    return array;
}

void checkDimensions(py::array const &array, char const *name, int numDimensions) {
    if (array.ndim() != numDimensions) {
        throw py::value_error(std::string(name) + ": " + std::to_string(numDimensions) +
                              (numDimensions == 1 ? " dimension is" : " dimensions are") +
                              " needed, the shape is " + DescribeShape(array));
    }
}

template <typename T>
py::array_t<int> narrow(py::array const &array, char const *name) {
    py::array_t<T, py::array::c_style | py::array::forcecast> const wide(array);
    py::array_t<int> narrowed(
        std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()));
    T const *const source = wide.data();
    int *const destination = narrowed.mutable_data();
    constexpr int kLeast = std::numeric_limits<int>::min(), kMost = std::numeric_limits<int>::max();
    for (py::ssize_t i = 0; i < wide.size(); ++i) {
        destination[i] = int(source[i]);
        bool const isTooSmall = std::is_signed_v<T> && source[i] < T(kLeast);
        if (isTooSmall || source[i] > T(kMost)) {
            throw py::value_error(std::string(name) + ": number " + std::to_string(i) + " is " +
                                  std::to_string(source[i]) + ", which 32 bits do not hold");
        }
    }
    return narrowed;
}

/// Whether numpy can read the numbers where they are: in the machine's byte order, aligned.
bool isAligned(py::array const &array) {
    return (array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) != 0;
}

template <typename REAL>
constexpr char const *typeName() {
    return sizeof(REAL) == sizeof(float) ? "float32" : "float64";
}

/// The place of the elements in an array of the right type.
template <typename REAL>
Elements<REAL> describe(py::array const &array, char const *name, void const *data) {
    if (array.ndim() != 1 && array.ndim() != 2) {
        throw py::value_error(std::string(name) +
                              ": one or two dimensions are needed, the shape is " +
                              DescribeShape(array));
    }
    constexpr py::ssize_t kMost = std::numeric_limits<int>::max();
    py::ssize_t const size = sizeof(REAL);
    py::ssize_t const length = array.ndim() == 2 ? array.shape(1) : 1;
    if (length < 1 || length > kMost || array.shape(0) > kMost) {
        throw py::value_error(std::string(name) + ": elements of the shape " +
                              DescribeShape(array) + " cannot be evaluated");
    }
    // Of a single element there is no next, and of single numbers none beside.
    py::ssize_t const stride = array.shape(0) > 1 ? array.strides(0) : length * size;
    if ((length > 1 && array.strides(1) != size) || stride % size != 0 || stride < length * size ||
        stride / size > kMost || !isAligned(array)) {
        throw py::value_error(std::string(name) +
                              ": the numbers of an element must lie side by side, and elements one "
                              "behind the other; numpy.ascontiguousarray makes such an array");
    }
    return {array, static_cast<REAL *>(const_cast<void *>(data)), int(array.shape(0)),
            Osd::BufferDescriptor(0, int(length), int(stride / size))};
}

template <typename REAL>
void checkType(py::array const &array, char const *name) {
    if (!py::isinstance<py::array_t<REAL>>(array)) {
        throw py::type_error(std::string(name) + ": " + typeName<REAL>() + " is needed, not " +
                             nameType(array) + "; .astype(numpy." + typeName<REAL>() +
                             ") makes it");
    }
}

void checkCount(py::array const &array, char const *name, int count) {
    if (array.ndim() == 0 || array.shape(0) != count) {
        throw py::value_error(std::string(name) + ": " + std::to_string(count) +
                              (count == 1 ? " element is" : " elements are") +
                              " needed, the shape is " + DescribeShape(array));
    }
}

} // namespace

std::string DescribeShape(py::array const &array) {
    return std::string(py::str(array.attr("shape")));
}

void CheckIndex(long long index, int size, char const *name) {
    if (index < 0 || index >= size) {
        throw py::index_error(std::string(name) + ": " + std::to_string(index) +
                              " is not one of the " + std::to_string(size));
    }
}

py::array_t<int> TakeIndices(py::handle object, char const *name, int numDimensions) {
    py::array const array = toArray(object, name);
    if (array.size() == 0 && array.ndim() <= 1) { // an empty list is one of floats to numpy
        return py::array_t<int>(std::vector<py::ssize_t>(std::size_t(numDimensions), 0));
    }
    checkDimensions(array, name, numDimensions);
    char const kind = array.dtype().kind();
    if (kind == 'i') {
        return narrow<std::int64_t>(array, name);
    }
    if (kind == 'u') {
        return narrow<std::uint64_t>(array, name);
    }
    throw py::type_error(std::string(name) + ": integers are needed, not " + nameType(array));
}

std::vector<float> TakeFloats(py::handle object, char const *name, std::size_t count) {
    py::array const array = toArray(object, name);
    char const kind = array.dtype().kind();
    if (kind != 'f' && kind != 'i' && kind != 'u') {
        throw py::type_error(std::string(name) + ": numbers are needed, not " + nameType(array));
    }
    py::array_t<float, py::array::c_style | py::array::forcecast> const floats(array);
    if (array.ndim() == 0) {
        return std::vector<float>(count, *floats.data());
    }
    checkDimensions(array, name, 1);
    if (std::size_t(floats.size()) != count) {
        throw py::value_error(std::string(name) + ": one number is needed, or " +
                              std::to_string(count) + " of them, not " +
                              std::to_string(floats.size()));
    }
    return std::vector<float>(floats.data(), floats.data() + floats.size());
}

bool IsDouble(py::handle object) { return py::isinstance<py::array_t<double>>(object); }

template <typename REAL>
Elements<REAL const> TakeSource(py::handle object, char const *name, int count) {
    py::array array;
    if (py::isinstance<py::array>(object)) {
        array = py::reinterpret_borrow<py::array>(object);
    } else {
        array = py::module_::import("numpy").attr("asarray")(object, py::dtype::of<REAL>());
    }
    checkType<REAL>(array, name);
    if (count >= 0) {
        checkCount(array, name, count);
    }
    return describe<REAL const>(array, name, array.data());
}

template <typename REAL>
Elements<REAL> TakeDestination(py::handle object, char const *name, int count,
                               Elements<REAL const> const &source) {
    int const length = source.desc.length;
    py::array array;
    if (object.is_none()) {
        std::vector<py::ssize_t> shape = {count};
        if (source.array.ndim() == 2) {
            shape.push_back(length);
        }
        array = py::array_t<REAL>(shape);
    } else if (py::isinstance<py::array>(object)) {
        array = py::reinterpret_borrow<py::array>(object);
    } else {
        throw py::type_error(std::string(name) + ": an array to write to is needed, not " +
                             nameType(object));
    }
    checkType<REAL>(array, name);
    checkCount(array, name, count);
    if (!array.writeable()) {
        throw py::value_error(std::string(name) + ": the array is read-only");
    }
    Elements<REAL> const destination = describe<REAL>(array, name, array.mutable_data());
    if (destination.desc.length != length) {
        throw py::value_error(std::string(name) + ": elements of " + std::to_string(length) +
                              " numbers are needed, as the source has, the shape is " +
                              DescribeShape(array));
    }
    return destination;
}

template <typename REAL>
void CheckApart(Elements<REAL const> const &source, Elements<REAL> const &destination,
                char const *name, int begin, int end) {
    py::module_ const numpy = py::module_::import("numpy");
    py::object const written =
        destination.array[py::slice(py::ssize_t(begin), py::ssize_t(end), 1)];
    // The second looks at each number, and so only where the first cannot tell.
    if (numpy.attr("may_share_memory")(source.array, written).template cast<bool>() &&
        numpy.attr("shares_memory")(source.array, written).template cast<bool>()) {
        throw py::value_error(std::string(name) + ": it shows the memory of numbers that are read");
    }
}

template <typename T>
py::array View(T const *data, std::vector<py::ssize_t> shape, py::object const &owner) {
    py::array array(py::dtype::of<T>(), std::move(shape), data, owner);
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

template Elements<float const> TakeSource<float>(py::handle, char const *, int);
template Elements<double const> TakeSource<double>(py::handle, char const *, int);
template Elements<float> TakeDestination<float>(py::handle, char const *, int,
                                                Elements<float const> const &);
template Elements<double> TakeDestination<double>(py::handle, char const *, int,
                                                  Elements<double const> const &);
template void CheckApart(Elements<float const> const &, Elements<float> const &, char const *, int,
                         int);
template void CheckApart(Elements<double const> const &, Elements<double> const &, char const *,
                         int, int);
template py::array View(int const *, std::vector<py::ssize_t>, py::object const &);
template py::array View(Far::LocalIndex const *, std::vector<py::ssize_t>, py::object const &);
template py::array View(float const *, std::vector<py::ssize_t>, py::object const &);
template py::array View(double const *, std::vector<py::ssize_t>, py::object const &);

} // namespace OpenSubdivHex::Python
