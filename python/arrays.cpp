// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <cmath>
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

/// Returns the array that numpy makes of an object.  Numpy's own errors, as of rows that differ in length, stay.
py::array toArray(py::handle object, char const *name) {
    if (object.is_none()) {
        throw py::type_error(std::string(name) + ": an array is needed, not None");
    }
    py::module_ const numpy = py::module_::import("numpy");
    if (py::isinstance<py::array>(object) &&
        numpy.attr("ma").attr("is_masked")(object).cast<bool>()) {
        throw py::value_error(std::string(name) + ": it has numbers that are masked");
    }
    return numpy.attr("asarray")(object);
}

void checkDimensions(py::array const &array, char const *name, int numDimensions) {
    if (array.ndim() != numDimensions) {
        throw py::value_error(std::string(name) + ": " + std::to_string(numDimensions) +
                              (numDimensions == 1 ? " dimension is" : " dimensions are") +
                              " needed, the shape is " + DescribeShape(array));
    }
}

/// The numbers as a T each, by numpy's rules, one behind the other; copied where they are not.
template <typename T>
py::array_t<T> gather(py::array const &array) {
    constexpr int kFlags =
        py::array::c_style | py::array::forcecast | py::detail::npy_api::NPY_ARRAY_ALIGNED_;
    return py::array_t<T, kFlags>(array);
}

template <typename T>
constexpr char const *typeName() {
    return std::is_integral_v<T> ? "int32" : sizeof(T) == sizeof(float) ? "float32" : "float64";
}

/// Whether a number is one of another type: an integer the same, others but for rounding.
template <typename TO, typename FROM>
bool isHeld(FROM number) {
    using Limits = std::numeric_limits<TO>;
    if constexpr (std::is_floating_point_v<FROM>) {
        return !std::isfinite(number) || std::abs(number) <= FROM(Limits::max());
    } else if constexpr (std::is_floating_point_v<TO>) {
        TO const converted = TO(number);
        return converted < std::ldexp(TO(1), std::numeric_limits<FROM>::digits) &&
               FROM(converted) == number;
    } else {
        return !(std::is_signed_v<FROM> && number < FROM(Limits::min())) &&
               number <= FROM(Limits::max());
    }
}

template <typename TO, typename FROM>
py::array_t<TO> convertFrom(py::array const &array, char const *name) {
    py::array_t<FROM> wide = gather<FROM>(array);
    if constexpr (std::is_same_v<TO, FROM>) {
        return wide;
    } else {
        py::array_t<TO> converted(
            std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()));
        FROM const *const source = wide.data();
        TO *const destination = converted.mutable_data();
        for (py::ssize_t i = 0; i < wide.size(); ++i) {
            if (!isHeld<TO>(source[i])) {
                throw py::value_error(std::string(name) + ": number " + std::to_string(i) + " is " +
                                      std::string(py::str(py::cast(source[i]))) + ", which " +
                                      typeName<TO>() + " does not hold");
            }
            destination[i] = TO(source[i]);
        }
        return converted;
    }
}

/// \brief Converts numbers to a type, where they are others or lie elsewhere than one behind the other.
///
/// Floating-point numbers are rounded.  What would be another number is refused.
template <typename TO>
py::array_t<TO> convert(py::array const &array, char const *name) {
    char const kind = array.dtype().kind();
    if (kind == 'i') {
        return convertFrom<TO, std::int64_t>(array, name);
    }
    if (kind == 'u') {
        return convertFrom<TO, std::uint64_t>(array, name);
    }
    if constexpr (std::is_floating_point_v<TO>) {
        if (py::isinstance<py::array_t<TO>>(array)) {
            return convertFrom<TO, TO>(array, name);
        }
        if (kind == 'f') {
            return array.itemsize() > py::ssize_t(sizeof(double))
                       ? convertFrom<TO, long double>(array, name)
                       : convertFrom<TO, double>(array, name);
        }
    }
    throw py::type_error(std::string(name) + (std::is_integral_v<TO> ? ": integers" : ": numbers") +
                         " are needed, not " + nameType(array));
}

/// The shape of elements.
void checkShape(py::array const &array, char const *name) {
    if (array.ndim() != 1 && array.ndim() != 2) {
        throw py::value_error(std::string(name) +
                              ": one or two dimensions are needed, the shape is " +
                              DescribeShape(array));
    }
    constexpr py::ssize_t kMost = std::numeric_limits<int>::max();
    py::ssize_t const length = array.ndim() == 2 ? array.shape(1) : 1;
    if (length < 1 || length > kMost || array.shape(0) > kMost) {
        throw py::value_error(std::string(name) + ": elements of the shape " +
                              DescribeShape(array) + " cannot be evaluated");
    }
}

/// How far elements are apart, in bytes.
py::ssize_t getStride(py::array const &array) {
    // A single element has no next one.
    return array.shape(0) > 1 ? array.strides(0)
                              : (array.ndim() == 2 ? array.shape(1) : 1) * array.itemsize();
}

/// Why elements cannot be read or written where they lie; null where they can.
char const *findObstacle(py::array const &array) {
    py::ssize_t const size = array.itemsize();
    py::ssize_t const length = array.ndim() == 2 ? array.shape(1) : 1;
    py::ssize_t const stride = getStride(array);
    if ((array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) == 0) {
        return "the array is not aligned";
    }
    if (length > 1 && array.strides(1) != size) {
        return "the numbers of an element must lie side by side";
    }
    if (stride % size != 0 || stride < length * size ||
        stride / size > std::numeric_limits<int>::max()) {
        return "elements must lie one behind the other, the first one first";
    }
    return nullptr;
}

/// The elements of an array that has no obstacle.
template <typename REAL>
Elements<REAL> describe(py::array const &array, void const *data) {
    return {array, static_cast<REAL *>(const_cast<void *>(data)), int(array.shape(0)),
            Osd::BufferDescriptor(0, array.ndim() == 2 ? int(array.shape(1)) : 1,
                                  int(getStride(array) / py::ssize_t(sizeof(REAL))))};
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
    return convert<int>(array, name);
}

std::vector<float> TakeFloats(py::handle object, char const *name, std::size_t count) {
    py::array_t<float> const floats = convert<float>(toArray(object, name), name);
    if (floats.ndim() == 0) {
        return std::vector<float>(count, *floats.data());
    }
    checkDimensions(floats, name, 1);
    if (std::size_t(floats.size()) != count) {
        throw py::value_error(std::string(name) + ": one number is needed, or " +
                              std::to_string(count) + " of them, not " +
                              std::to_string(floats.size()));
    }
    return std::vector<float>(floats.data(), floats.data() + floats.size());
}

bool IsDouble(py::handle object) {
    if (!py::isinstance<py::array>(object)) {
        return false;
    }
    py::dtype const type = py::reinterpret_borrow<py::array>(object).dtype();
    return type.kind() == 'f' && type.itemsize() >= py::ssize_t(sizeof(double));
}

template <typename REAL>
Elements<REAL const> TakeSource(py::handle object, char const *name, int count, bool isDense) {
    py::array array = toArray(object, name);
    if (count >= 0) {
        checkCount(array, name, count);
    }
    checkShape(array, name);
    bool const isInPlace = py::isinstance<py::array_t<REAL>>(array) && !findObstacle(array) &&
                           (!isDense || (array.flags() & py::array::c_style) != 0);
    if (!isInPlace) {
        array = convert<REAL>(array, name);
    }
    return describe<REAL const>(array, array.data());
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
    if (!py::isinstance<py::array_t<REAL>>(array)) {
        throw py::type_error(std::string(name) + ": " + typeName<REAL>() + " is needed, not " +
                             nameType(array));
    }
    checkCount(array, name, count);
    checkShape(array, name);
    if (!array.writeable()) {
        throw py::value_error(std::string(name) + ": the array is read-only");
    }
    if (char const *const obstacle = findObstacle(array)) {
        throw py::value_error(std::string(name) + ": " + obstacle);
    }
    Elements<REAL> destination = describe<REAL>(array, array.mutable_data());
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

template Elements<float const> TakeSource<float>(py::handle, char const *, int, bool);
template Elements<double const> TakeSource<double>(py::handle, char const *, int, bool);
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
