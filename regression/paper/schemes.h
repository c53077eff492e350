// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PAPER_SCHEMES_H
#define OPENSUBDIVHEX_REGRESSION_PAPER_SCHEMES_H

#include "far_ext/schemeOptions.h"

namespace OpenSubdivHex::Regression {

using FarExt::FaceMask;
using FarExt::SchemeOptions;
using FarExt::SchemeType;

constexpr SchemeOptions MakeHexagonal(FaceMask mask) {
    return {mask, SchemeType::Hexagonal, false};
}
constexpr SchemeOptions MakeTriHexFirst(FaceMask mask) {
    return {mask, SchemeType::Hexagonal, true};
}
constexpr SchemeOptions MakeDooSabin(FaceMask mask) { return {mask, SchemeType::DooSabin, false}; }
constexpr SchemeOptions MakeTriHex() { return {FaceMask::Average, SchemeType::TriHex, false}; }

} // namespace OpenSubdivHex::Regression

#endif
