// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PAPER_SCHEMES_H
#define OPENSUBDIVHEX_REGRESSION_PAPER_SCHEMES_H

#include "far_ext/hexSchemeOptions.h"

namespace OpenSubdivHex::Regression {

using FarExt::FaceMask;
using FarExt::HexSchemeOptions;
using FarExt::SchemeType;

constexpr HexSchemeOptions MakeHexagonal(FaceMask mask) {
    return {mask, SchemeType::Hexagonal, false};
}
constexpr HexSchemeOptions MakeTriHexFirst(FaceMask mask) {
    return {mask, SchemeType::Hexagonal, true};
}
constexpr HexSchemeOptions MakeDooSabin(FaceMask mask) {
    return {mask, SchemeType::DooSabin, false};
}
constexpr HexSchemeOptions MakeTriHex() { return {FaceMask::Average, SchemeType::TriHex, false}; }

} // namespace OpenSubdivHex::Regression

#endif
