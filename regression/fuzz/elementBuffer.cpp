// SPDX-License-Identifier: Apache-2.0
#include "elementBuffer.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Regression {

namespace {

constexpr float kUntouched = -12345.678f;

double valueAt(ReferenceValues const &values, int row, int k) {
    return values(row, k % values.cols());
}

} // namespace

ElementBuffer::ElementBuffer(int numElements, int length, Dice &dice)
    : desc(dice.Roll(4), length, length + dice.Roll(3)),
      floats(std::size_t(desc.offset + std::max(0, numElements * desc.stride)), kUntouched) {}

ElementBuffer MakeSource(ReferenceValues const &values, int length, Dice &dice) {
    ElementBuffer source(int(values.rows()), length, dice);
    for (int i = 0; i < int(values.rows()); ++i) {
        for (int k = 0; k < length; ++k) {
            source.At(i, k) = float(valueAt(values, i, k));
        }
    }
    return source;
}

void CheckElements(ElementBuffer &buffer, int begin, int end, ReferenceValues const &expected,
                   int first, double allowed, std::string const &name) {
    for (int i = begin; i < end; ++i) {
        for (int k = 0; k < buffer.desc.length; ++k) {
            double const difference =
                std::abs(double(buffer.At(i, k)) - valueAt(expected, first + i - begin, k));
            if (!(difference <= allowed)) {
                Fail(name, " gives ", buffer.At(i, k), " for element ", i, ", float ", k, ", not ",
                     valueAt(expected, first + i - begin, k));
            }
        }
    }
    for (int j = 0; j < int(buffer.floats.size()); ++j) {
        int const relative = j - buffer.desc.offset - begin * buffer.desc.stride;
        bool const isElement = relative >= 0 && relative < (end - begin) * buffer.desc.stride &&
                               relative % buffer.desc.stride < buffer.desc.length;
        if (!isElement && buffer.floats[std::size_t(j)] != kUntouched) {
            Fail(name, " writes float ", j, ", which is of no element");
        }
    }
}

} // namespace OpenSubdivHex::Regression
