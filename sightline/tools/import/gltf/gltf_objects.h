// Turns drawn nodes into a scene: one mesh per shape, one object per node or GPU instance, cameras.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/tools/import/gltf/gltf_document.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools::gltf {

/// Everything of the document that a scene holds; a Fault if it draws no triangle and marks no cell or portal.
Scene makeScene(Document& document);

}  // namespace sightline::tools::gltf
