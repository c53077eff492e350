// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PAPER_SCHEMES_H
#define OPENSUBDIVHEX_REGRESSION_PAPER_SCHEMES_H

#include "far_ext/hexSchemeOptions.h"

namespace OpenSubdivHex::Regression {

using FarExt::FaceMask;
using FarExt::FirstStep;
using FarExt::HexSchemeOptions;
using FarExt::SchemeType;

constexpr HexSchemeOptions MakeHexagonal(FaceMask mask) {
    return {mask, SchemeType::Hexagonal, FirstStep::Same};
}
constexpr HexSchemeOptions MakeTriHexFirst(FaceMask mask) {
    return {mask, SchemeType::Hexagonal, FirstStep::TriHex};
}
constexpr HexSchemeOptions MakeTruncateFirst(FaceMask mask) {
    return {mask, SchemeType::Hexagonal, FirstStep::Truncate};
}
constexpr HexSchemeOptions MakeDooSabin(FaceMask mask) {
    return {mask, SchemeType::DooSabin, FirstStep::Same};
}
constexpr HexSchemeOptions MakeTriHex() {
    return {FaceMask::Average, SchemeType::TriHex, FirstStep::Same};
}

} // namespace OpenSubdivHex::Regression

#endif
