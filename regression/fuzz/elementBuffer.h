// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FUZZ_ELEMENT_BUFFER_H
#define OPENSUBDIVHEX_REGRESSION_FUZZ_ELEMENT_BUFFER_H

#include "oracle.h"

#include "regression/osd_ext/evaluators.h"

#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// A buffer that an evaluator reads or writes: elements with some offset and stride, in floats that have a value
/// of their own where nobody wrote.
struct ElementBuffer {
    ElementBuffer(int numElements, int length, Dice &dice);

    float &At(int element, int k) {
        return floats[std::size_t(desc.offset + element * desc.stride + k)];
    }

    Descriptor desc;
    std::vector<float> floats;
};

/// Values as floats: their columns, again and again up to \p length.
ElementBuffer MakeSource(ReferenceValues const &values, int length, Dice &dice);

/// Fails unless elements [begin, end) of a buffer are rows [first, ...) of the values, made as a source,
/// and nothing else was written.
void CheckElements(ElementBuffer &buffer, int begin, int end, ReferenceValues const &expected,
                   int first, double allowed, std::string const &name);

} // namespace OpenSubdivHex::Regression

#endif
