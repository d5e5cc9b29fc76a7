// Turns drawn nodes into a scene: one mesh per shape, one object per node or GPU instance, cameras.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/import/gltf_document.h"
#include "sightline/scene/scene.h"

namespace sightline::gltf {

/// Everything of the document that a scene holds; a Fault if it draws no triangle and marks no cell or portal.
Scene makeScene(Document& document);

}  // namespace sightline::gltf
