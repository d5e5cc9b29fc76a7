// Where a compiled map's bytes come from: a file, or a file in an archive.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/tools/import/quake/quake_bsp.h"

namespace sightline::tools {

/// "pak0.pk3:maps/x.bsp" by its two parts; without a second part the first is the whole name.
struct MapName {
    std::string file;   ///< on disk
    std::string entry;  ///< in it; empty: none was named
};

/// A name with `.pak:` or `.pk3:` in it names an entry, unless there is such a file.
MapName splitMapName(const std::string& name);

struct MapBytes {
    std::string name;  ///< as errors tell it: the file, and the entry where it lies in an archive
    std::vector<unsigned char> bytes;
};

/// Reads `x.bsp`, `x.pak:maps/y.bsp`, `x.pk3:maps/y.bsp`; of an archive alone its only map. An entry's letters may be of
/// either case.
///
/// Errors (kInput) are one line with the name: what cannot be read or unpacked, an archive without such an entry, or
/// with no map or several, which are then listed.
Result<MapBytes> readMapBytes(const std::string& name);

/// The same, parsed. Errors of either.
Result<QuakeMapFile> readQuakeMap(const std::string& name);

}  // namespace sightline::tools
