// Decodes accessors: normalised and quantised components, strides, sparse replacements.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/tools/import/gltf/gltf_document.h"

namespace sightline::tools::gltf {

/// The elements of an accessor as finite floats, one after another; integers are normalised if the accessor
/// says so.
/// @param components  how many each element must have
/// @param what        the accessor's role, for the Fault if it is unfit
/// @return            [size: components * count]
std::vector<float> decodeFloats(Document& document, uint32_t accessor, uint32_t components, const char* what);

/// The elements of a SCALAR or VEC accessor of unsigned integers.
/// @return  [size: components * count]
std::vector<uint32_t> decodeIntegers(Document& document, uint32_t accessor, uint32_t components, const char* what);

}  // namespace sightline::tools::gltf
