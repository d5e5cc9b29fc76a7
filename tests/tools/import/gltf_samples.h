// Small valid files, one for each thing that the glTF reader understands: tests read them, the fuzzer starts there.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "gltf_builder.h"

namespace sightline::test {

struct Sample {
    std::string name;
    std::string bytes;
};

/// All of them; each loads.
std::vector<Sample> gltfSamples();

/// The one of that name; an empty text if there is none.
std::string gltfSample(const std::string& name);

/// The groups that gltfSamples gathers.
void addGeometrySamples(std::vector<Sample>& out);
void addNodeSamples(std::vector<Sample>& out);
void addCompressedSamples(std::vector<Sample>& out);
void addDeformingSamples(std::vector<Sample>& out);
#ifdef SIGHTLINE_HAS_DRACO
void addDracoSamples(std::vector<Sample>& out);
#endif

}  // namespace sightline::test
